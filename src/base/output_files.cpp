#include "base/output_files.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/errors.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

/// Whether both are one file, by whatever way: a link, a relative path. They need not be there.
bool areSame(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  return fs::weakly_canonical(fs::absolute(a), error) == fs::weakly_canonical(fs::absolute(b), error);
}

/// A file that is there, in a folder that is read.
bool isIn(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error) || !fs::exists(file, error)) return false;
  return areSame(fs::absolute(file).parent_path(), folder);
}

void requireWritable(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw WriteError(path, "is a folder");
  if (fs::exists(path, error) && ::access(path.c_str(), W_OK) != 0) throw WriteError(path, std::strerror(errno));
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) return;  // a device, a pipe
  try {
    requireWritableFolder(fs::absolute(path).parent_path().string());
  } catch (const WriteError& reason) {
    const std::string text = reason.what();
    throw WriteError(path, text.substr(text.rfind(": ") + 2));
  }
}

}  // namespace

OutputFiles& OutputFiles::reads(const std::string& option, const std::string& path) {
  if (!path.empty()) inputs_.emplace_back(option, path);
  return *this;
}

OutputFiles& OutputFiles::writes(const std::string& option, const std::string& path) {
  if (!path.empty() && path != "-") outputs_.emplace_back(option, path);
  return *this;
}

void OutputFiles::check() const {
  std::vector<std::string> errors;
  for (auto output = outputs_.begin(); output != outputs_.end(); ++output) {
    const std::string found = output->first + " = " + output->second + ": must be another file than ";
    for (const Named& input : inputs_) {
      if (areSame(output->second, input.second)) errors.push_back(found + input.first + ", which is read");
      if (isIn(output->second, input.second)) errors.push_back(found + "those of " + input.first + ", which are read");
    }
    for (auto other = outputs_.begin(); other != output; ++other) {
      if (areSame(output->second, other->second)) errors.push_back(found + other->first + ", which is written, too");
    }
  }
  if (!errors.empty()) throw ConfigError(errors);
  for (const Named& output : outputs_) requireWritable(output.second);
}

}  // namespace microinjection
