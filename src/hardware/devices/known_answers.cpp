#include "hardware/devices/known_answers.h"

#include <cctype>
#include <regex>
#include <vector>

namespace microinjection {
namespace {

struct AnswerForm {
  const char* name;
  std::regex line;
};

/// The first whose form a line has. What several devices say ("A", "OK") comes last.
const std::vector<AnswerForm>& answerForms() {
  static const std::vector<AnswerForm> all = {
      {"a Zaber", std::regex(R"([@#!]\d\d \d.*)")},
      {"an Eppendorf", std::regex(R"(A\d{3}\b.*|ERR=\d+)")},
      {"a Scientifica", std::regex(R"(Y519|E,\d+|-?\d+\t-?\d+\t-?\d+|Scientifica.*)")},
      {"a GPS receiver", std::regex(R"(\$G[A-Z]{4},.*)")},
      {"a modem", std::regex(R"(AT.*|RING|NO CARRIER|\+C[A-Z]+:.*)")},
      {"a login on another computer", std::regex(R"(.*login: ?|.*[Pp]assword: ?)")},
      {"a stream of numbers, such as a force sensor's voltages",
       std::regex(R"(\s*[-+]?\d+\.\d+([,;\t ]+[-+]?\d+\.\d+)*\s*)")},
      {"a Scientifica", std::regex(R"(A|E)")},
  };
  return all;
}

bool isAnswerText(unsigned char each) { return std::isprint(each) || each == '\t' || each == '\r' || each == '\n'; }

std::vector<std::string> answerLines(const std::string& bytes) {
  std::vector<std::string> lines(1);
  for (const char each : bytes) {
    if (each == '\r' || each == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += each;
    }
  }
  return lines;
}

/// Positions of Sutter's controllers: three numbers of 4 bytes and CR; the MPC-200 begins with the number of its drive.
std::string nameOfBinary(const std::string& bytes) {
  const unsigned char first = static_cast<unsigned char>(bytes[0]), last = static_cast<unsigned char>(bytes.back());
  if (last == '\r' && (bytes.size() == 13 || bytes.size() == 33)) return "a Sutter MP-285";
  if (last == '\r' && bytes.size() == 14 && first >= 1 && first <= 4) return "a Sutter MPC-200";
  if (first == 0xff && bytes.size() > 2 && static_cast<unsigned char>(bytes[1]) >= 0xfa) return "a telnet server";
  return "something that sends " + std::to_string(bytes.size()) + " bytes that are no text";
}

}  // namespace

std::string nameOfAnswer(const std::string& bytes) {
  if (bytes.empty()) return "";
  std::string text;
  for (const char each : bytes) {
    if (!isAnswerText(static_cast<unsigned char>(each))) return nameOfBinary(bytes);
  }
  for (const AnswerForm& form : answerForms()) {
    for (const std::string& line : answerLines(bytes)) {
      if (std::regex_match(line, form.line)) return form.name;
    }
  }
  if (bytes.find_first_not_of("\r=") == std::string::npos) return "a Sutter MP-285";
  for (const char each : bytes.substr(0, 40)) text += std::isprint(static_cast<unsigned char>(each)) ? each : ' ';
  return "something that says \"" + text + "\"";
}

}  // namespace microinjection
