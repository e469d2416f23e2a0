#include "hardware/serial/line_splitter.h"

#include <utility>

namespace microinjection {

LineSplitter::LineSplitter(std::string terminator, std::size_t longest)
    : terminator_(std::move(terminator)), longest_(longest) {}

std::vector<std::string> LineSplitter::feed(const std::string& bytes) {
  std::vector<std::string> lines;
  begun_ += bytes;
  std::size_t from = 0;
  for (std::size_t end; (end = begun_.find(terminator_, from)) != std::string::npos; from = end + terminator_.size()) {
    if (std::exchange(skipping_, false)) continue;
    if (end - from > longest_) {
      ++too_long_;
    } else {
      lines.push_back(begun_.substr(from, end - from));
    }
  }
  begun_.erase(0, from);
  // The dropped bytes may end with the beginning of a terminator.
  if (begun_.size() > longest_ + terminator_.size()) {
    too_long_ += skipping_ ? 0 : 1;
    skipping_ = true;
    begun_.erase(0, begun_.size() - terminator_.size() + 1);
  }
  return lines;
}

void LineSplitter::clear(bool in_mid_line) {
  begun_.clear();
  skipping_ = in_mid_line;
}

}  // namespace microinjection
