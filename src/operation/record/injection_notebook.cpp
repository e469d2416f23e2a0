#include "operation/record/injection_notebook.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/atomic_file.h"

namespace microinjection {
namespace {

std::string csvQuoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c == '\n' || c == '\r' ? ' ' : c;  // a line is an entry
  }
  return result + '"';
}

class Line {
 public:
  Line() { out_.precision(6); }
  void add(const std::string& text) { out_ << separator() << csvQuoted(text); }
  void add(double value) { out_ << separator() << value; }
  void add(unsigned value) { out_ << separator() << value; }
  void add(const std::optional<double>& value) { value ? add(*value) : add(std::string()); }
  void add(const std::optional<NotebookEntry::Estimate>& interval) {
    for (const double NotebookEntry::Estimate::*part :
         {&NotebookEntry::Estimate::value, &NotebookEntry::Estimate::low, &NotebookEntry::Estimate::high}) {
      add(interval ? std::optional<double>((*interval).*part) : std::nullopt);
    }
  }
  std::string finish() { return out_.str() + '\n'; }

 private:
  const char* separator() { return std::exchange(first_, false) ? "" : ","; }

  std::ostringstream out_;
  bool first_ = true;
};

std::string contentOf(const std::string& path) {
  if (!std::filesystem::exists(path)) return "";
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return content.str();
}

}  // namespace

const char* const kNotebookHeader =
    "time,cell,diameter_m,modulus_Pa,modulus_low_Pa,modulus_high_Pa,verdict,expected_depth_m,expected_depth_low_m,"
    "expected_depth_high_m,expected_force_N,expected_force_low_N,expected_force_high_N,puncture_depth_m,"
    "puncture_force_N,peak_force_N,deepest_m,punctures,volume_m3,outcome,reason\n";

std::string toLine(const NotebookEntry& entry) {
  Line line;
  line.add(entry.time);
  line.add(entry.cell);
  line.add(entry.diameter);
  line.add(entry.modulus);
  line.add(entry.verdict);
  line.add(entry.expected_depth);
  line.add(entry.expected_force);
  line.add(entry.puncture_depth);
  line.add(entry.puncture_force);
  line.add(entry.peak_force);
  line.add(entry.deepest);
  line.add(entry.punctures);
  line.add(entry.volume);
  line.add(entry.outcome);
  line.add(entry.reason);
  return line.finish();
}

void appendToNotebook(const std::string& path, const NotebookEntry& entry) {
  std::string content = contentOf(path);
  if (content.empty()) content = kNotebookHeader;
  if (content.rfind(kNotebookHeader, 0) != 0) throw std::runtime_error(path + ": is not a notebook of injections");
  if (content.back() != '\n') content += '\n';
  writeFileAtomically(path, content + toLine(entry));
}

}  // namespace microinjection
