#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace microinjection {

/// Cuts a stream of bytes into lines, however they arrive.
class LineSplitter {
 public:
  /// `terminator` ends a line and is not part of it. Of a line longer than `longest` bytes nothing is kept.
  /// @pre terminator is not empty
  LineSplitter(std::string terminator, std::size_t longest);

  /// Takes what has come and returns the lines that are now complete.
  std::vector<std::string> feed(const std::string& bytes);

  /// Forgets the begun line; with `in_mid_line` also what is still to come of it, for a line that was opened while the
  /// device was talking.
  void clear(bool in_mid_line);

  unsigned tooLong() const { return too_long_; }  ///< lines that were dropped for their length

 private:
  std::string terminator_;
  std::size_t longest_;
  std::string begun_;
  bool skipping_ = false;  ///< to the next terminator
  unsigned too_long_ = 0;
};

}  // namespace microinjection
