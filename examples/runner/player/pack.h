#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace tendril::runner {

/// Named arrays of integers, small in a page: what is alike from element to element, or from moment to
/// moment, costs little. Read by page/data.js.
class Pack {
 public:
  /// \param stride  how many elements lie between those that are alike
  /// \param order   how often differences are taken: 1 where they are near each other, 2 where they move
  ///                evenly. Values and differences must fit 31 bits and a sign
  void add(const std::string& name, const std::vector<std::int32_t>& values, std::size_t stride = 1,
           int order = 1);

  /// Where each array is, and how to read it.
  const nlohmann::ordered_json& sections() const { return sections_; }
  /// All of it, deflated, in base64.
  std::string text() const;

 private:
  nlohmann::ordered_json sections_;
  std::string bytes_;
};

}  // namespace tendril::runner
