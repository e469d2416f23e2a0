#include "hardware/serial/line_ending.h"

#include <algorithm>
#include <cstdio>
#include <map>

namespace microinjection {
namespace {

bool isControl(unsigned char c) { return c < 0x20 || c == 0x7f; }

/// The first control character as data sheets write it; empty: there is none.
std::string controlCharacter(const std::string& text) {
  const auto found = std::find_if(text.begin(), text.end(), isControl);
  if (found == text.end()) return "";
  const auto code = static_cast<unsigned char>(*found);
  if (code == '\r') return "a carriage return (0x0D)";
  if (code == '\n') return "a line feed (0x0A)";
  if (code == '\t') return "a tabulator (0x09)";
  char name[32];
  std::snprintf(name, sizeof name, "a control character (0x%02X)", code);
  return name;
}

}  // namespace

void readLineEnding(ConfigReader& reader, const std::string& key, std::string& bytes, NoLineEnding none) {
  static const std::map<std::string, std::string> endings{{"CR", "\r"}, {"LF", "\n"}, {"CRLF", "\r\n"}};
  std::string name;
  reader.text(key, name);
  if (name.empty() && !reader.has(key)) return;
  const bool may_be_none = none == NoLineEnding::kAllowed;
  if (may_be_none && name == "NONE") return bytes.clear();
  const auto found = endings.find(name);
  if (found != endings.end()) {
    bytes = found->second;
    return;
  }
  const std::string control = controlCharacter(name);
  reader.error(key, "must be one of the names CR, LF, CRLF" + std::string(may_be_none ? ", NONE" : "") +
                        (control.empty() ? "" : ", and has " + control));
}

void readPlainText(ConfigReader& reader, const std::string& key, std::string& text, ConfigReader::Presence presence) {
  reader.text(key, text, presence);
  const std::string control = controlCharacter(text);
  if (control.empty()) return;
  reader.error(key, "has " + control + ", which does not survive a parameter server; " +
                        "the line's end is not written here but by its name, CR, LF or CRLF, under terminator");
}

}  // namespace microinjection
