#pragma once

#include <string>
#include <utility>
#include <vector>

namespace microinjection {

/// What a program reads and what it will write, by the options that name them. No output replaces an input or another
/// output, and each can be written: both are known before the work begins.
class OutputFiles {
 public:
  /// A file that is read, or a folder whose files are; empty: none.
  OutputFiles& reads(const std::string& option, const std::string& path);
  /// A file that will be written; empty, or - for the standard output: none.
  OutputFiles& writes(const std::string& option, const std::string& path);
  /// Creates missing folders of the outputs. Throws ConfigError that names all outputs that are inputs, and WriteError
  /// for the first one that cannot be written.
  void check() const;

 private:
  using Named = std::pair<std::string, std::string>;  ///< option and path
  std::vector<Named> inputs_, outputs_;
};

}  // namespace microinjection
