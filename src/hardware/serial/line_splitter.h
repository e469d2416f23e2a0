#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace microinjection {

/// Splits a stream of bytes into lines, regardless of how the bytes are grouped.
class LineSplitter {
 public:
  /// `terminator` ends a line and is not part of it. Lines longer than `longest` bytes are dropped.
  /// @pre terminator is not empty
  LineSplitter(std::string terminator, std::size_t longest);

  /// Adds received bytes and returns the lines that are now complete.
  std::vector<std::string> feed(const std::string& bytes);

  /// Drops the incomplete line. With `in_mid_line` its remainder is dropped, too: the port may have
  /// been opened while the device was sending.
  void clear(bool in_mid_line);

  bool inMidLine() const { return !begun_.empty(); }  ///< the beginning of a line has come
  unsigned tooLong() const { return too_long_; }      ///< lines dropped because of their length

 private:
  std::string terminator_;
  std::size_t longest_;
  std::string begun_;
  bool skipping_ = false;  ///< until the next terminator
  unsigned too_long_ = 0;
};

}  // namespace microinjection
