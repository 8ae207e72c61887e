#pragma once

#include <string>
#include <vector>

namespace tendril::bind {

/// Where a reader tells what it read in a way of its own or left out. Without a list nobody would be told, so
/// it refuses instead.
class Notes {
 public:
  explicit Notes(std::vector<std::string>* list) : list_(list) {}

  bool tolerant() const { return list_ != nullptr; }
  void add(std::string note) const { list_->push_back(std::move(note)); }

 private:
  std::vector<std::string>* list_;
};

/// Normals or colors: worth having, but no reason to refuse a surface. The first bad value drops them all,
/// with a note; where nobody would be told it is an error.
class Decoration {
 public:
  Decoration(const char* name, const Notes& notes) : name_(name), notes_(notes) {}

  bool dropped() const { return dropped_; }

  /// Without a word: the reason was told already.
  void drop() { dropped_ = true; }

  template <class Cursor>
  void refuse(const Cursor& in, const std::string& reason, const std::string& expected) {
    if (!notes_.tolerant()) in.fail(reason, expected);
    if (!dropped_) notes_.add(in.place() + reason + ": " + name_ + " dropped");
    dropped_ = true;
  }

 private:
  const char* name_;
  Notes notes_;
  bool dropped_ = false;
};

}  // namespace tendril::bind
