#pragma once

#include "scene/json/json_node.h"

#include <algorithm>
#include <string>
#include <vector>

namespace tendril::scene {

/// What the parser's eleven events say of the place in the text: a value that holds no others, a key, the
/// begin and the end of an array or object, each false to stop there. Keeps the path of keys and indices; the
/// index of an array is that of the value being read, until that ends.
class JsonWalk : public nlohmann::json_sax<Json> {
 public:
  bool null() final { return scalar(); }
  bool boolean(bool) final { return scalar(); }
  bool number_integer(number_integer_t) final { return scalar(); }
  bool number_unsigned(number_unsigned_t) final { return scalar(); }
  bool number_float(number_float_t, const string_t&) final { return scalar(); }
  bool string(string_t&) final { return scalar(); }
  bool binary(binary_t&) final { return scalar(); }
  bool key(string_t& key) final {
    levels_.back().key = key;
    return at_key();
  }
  bool start_object(std::size_t) final { return open(false); }
  bool start_array(std::size_t) final { return open(true); }
  bool end_object() final { return close(); }
  bool end_array() final { return close(); }

 protected:
  struct Level {
    bool is_array;
    std::size_t index = 0;
    std::string key{};
  };

  virtual bool at_scalar() { return true; }
  virtual bool at_key() = 0;
  virtual bool at_open() = 0;  ///< before it is a level
  virtual void at_close() {}   ///< while it is one
  const std::vector<Level>& levels() const { return levels_; }

  /// Of the outermost levels, all by default.
  std::string pointer(std::size_t levels = std::string::npos) const {
    std::string out;
    for (std::size_t i = 0; i < std::min(levels, levels_.size()); ++i)
      out += "/" + (levels_[i].is_array ? std::to_string(levels_[i].index) : escape(levels_[i].key));
    return out;
  }

 private:
  bool scalar() {
    const bool go_on = at_scalar();
    if (!levels_.empty()) ++levels_.back().index;
    return go_on;
  }
  bool open(bool is_array) {
    if (!at_open()) return false;
    levels_.push_back({is_array});
    return true;
  }
  bool close() {
    at_close();
    levels_.pop_back();
    if (!levels_.empty()) ++levels_.back().index;
    return true;
  }

  std::vector<Level> levels_;
};

}  // namespace tendril::scene
