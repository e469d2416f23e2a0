#include "operation/readiness/remedies.h"

#include <algorithm>
#include <sstream>

#include "operation/readiness/troubleshooting_page.h"

namespace microinjection {
namespace {

constexpr std::size_t kFewestLetters = 6;  // of a pattern: a shorter one is a name or a value
constexpr std::size_t kFewestWords = 2;    // of one: else it is a name
constexpr std::size_t kLongestReason = 500;
constexpr const char* kCode = "    ";  // begins a line of a block of code, which belongs to what is before it

/// The rest of a line that begins an item of a list; none: it does not.
std::optional<std::string> itemBegun(const std::string& line) {
  static const std::regex begin(R"(^(?:- |\d+\. )(.*))");
  std::smatch match;
  return std::regex_match(line, match, begin) ? std::optional<std::string>(match[1]) : std::nullopt;
}

std::string withoutMarks(std::string text) {
  text = std::regex_replace(text, std::regex(R"(\[([^\]]*)\]\([^)]*\))"), "$1");  // links
  return std::regex_replace(text, std::regex("[*`]"), "");
}

/// The reasons that an item begins with: a row of backticks.
std::string reasonsOf(const std::string& item) {
  static const std::regex reasons(R"(^(?:\*\*[^*]*\*\* )?`[^`]*`(?:(?:, | and | or )`[^`]*`)*)");
  std::smatch match;
  return std::regex_search(item, match, reasons) ? match.str() : "";
}

std::size_t wordsOf(const std::string& text) {
  std::istringstream words(text);
  std::string word;
  std::size_t count = 0;
  while (words >> word) ++count;
  return count;
}

std::string capitalized(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

Remedies::Remedies(const std::string& markdown) {
  std::istringstream lines(markdown);
  std::string line, section, item;
  const auto finish = [&] {
    if (!item.empty()) addItem(item, section);
    item.clear();
  };
  for (bool blank = false; std::getline(lines, line); blank = line.empty()) {
    const std::optional<std::string> begun = itemBegun(line);
    const bool code = line.rfind(kCode, 0) == 0;
    if (begun || (blank && !line.empty() && !code) || line[0] == '#') finish();
    const std::string words = begun ? *begun : line.substr(std::min(line.find_first_not_of("# "), line.size()));
    if (line[0] == '#')
      section = words;
    else if (!words.empty())
      item += (item.empty() ? "" : " ") + words;
  }
  finish();
}

void Remedies::addItem(const std::string& item, const std::string& section) {
  static const std::regex quoted("`([^`]*)`");
  static const std::regex status(R"(^ \([^)]*\))");  // that has them
  const std::size_t end = reasonsOf(item).size();
  std::string rest = std::regex_replace(item.substr(end), status, "");
  rest.erase(0, std::min(rest.find_first_not_of(":,.; "), rest.size()));
  const Remedy remedy{capitalized(withoutMarks(rest)), section};
  for (auto each = std::sregex_iterator(item.begin(), item.end(), quoted); each != std::sregex_iterator(); ++each) {
    const bool leads = static_cast<std::size_t>(each->position()) < end;
    const std::string pattern = (*each)[1];
    if (wordsOf(pattern) >= kFewestWords) addPattern(pattern, leads ? remedy : Remedy{withoutMarks(item), section});
  }
}

void Remedies::addPattern(const std::string& pattern, const Remedy& remedy) {
  static const std::regex special(R"([.^$|()\[\]{}*+?\\])"), placeholder(R"(\b(?:N|NAME|TOPIC|KEY)\b)");
  std::string expression, literal;
  for (std::size_t from = 0; from <= pattern.size();) {
    const std::size_t gap = std::min(pattern.find("...", from), pattern.size());
    const std::string part = pattern.substr(from, gap - from);
    literal += std::regex_replace(part, placeholder, "");
    expression += std::regex_replace(std::regex_replace(part, special, R"(\$&)"), placeholder, ".+");
    if (gap < pattern.size()) expression += ".*";
    from = gap + 3;
  }
  const auto letters = static_cast<std::size_t>(
      std::count_if(literal.begin(), literal.end(), [](unsigned char c) { return std::isalpha(c); }));
  if (letters >= kFewestLetters) entries_.push_back({pattern, std::regex(expression), letters, remedy});
}

std::optional<Remedies::Remedy> Remedies::of(const std::string& whole) const {
  const std::string reason = whole.substr(0, kLongestReason);
  const Entry* best = nullptr;
  for (const Entry& entry : entries_) {
    if ((best == nullptr || entry.letters > best->letters) && std::regex_search(reason, entry.expression))
      best = &entry;
  }
  return best == nullptr ? std::nullopt : std::optional<Remedy>(best->remedy);
}

std::vector<std::string> Remedies::patterns() const {
  std::vector<std::string> all;
  for (const Entry& entry : entries_) all.push_back(entry.pattern);
  return all;
}

const Remedies& Remedies::builtIn() {
  static const Remedies remedies(troubleshootingPage());
  return remedies;
}

}  // namespace microinjection
