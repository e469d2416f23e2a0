#include "vision/camera/natural_order.h"

#include <cctype>
#include <cstddef>

namespace microinjection {
namespace {

bool digitAt(const std::string& text, std::size_t i) {
  return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]));
}

/// Takes the run of digits at `i`, without leading zeros, and moves `i` behind it.
std::string takeNumber(const std::string& text, std::size_t& i) {
  while (text[i] == '0' && digitAt(text, i + 1)) ++i;
  const std::size_t begin = i;
  while (digitAt(text, i)) ++i;
  return text.substr(begin, i - begin);
}

}  // namespace

bool naturalLess(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digitAt(a, i) && digitAt(b, j)) {
      const std::string left = takeNumber(a, i), right = takeNumber(b, j);
      // Of two numbers without leading zeros the longer one is larger, whatever their length.
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

}  // namespace microinjection
