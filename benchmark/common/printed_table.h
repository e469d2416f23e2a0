#pragma once

#include <cstdio>
#include <string>

namespace microinjection {

/// A table that is printed while it grows: long work shows its rows.
class PrintedTable {
 public:
  void add(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    text_ += text;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace microinjection
