#include "base/standard_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "base/atomic_file.h"
#include "base/errors.h"

namespace microinjection {

void flushStandardOutput() {
  errno = 0;
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  const int reason = errno;
  if (flushed && std::ferror(stdout) == 0 && std::cout) return;
  // errno is 0 when an earlier write failed, because the output exceeded the buffer.
  throw WriteError("the standard output", reason != 0 ? std::strerror(reason) : "an earlier write failed");
}

void writeTable(const std::string& file, const std::string& table) {
  if (file != "-") return writeFileAtomically(file, table);
  std::cout << table;
  flushStandardOutput();
}

}  // namespace microinjection
