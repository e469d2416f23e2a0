#include "base/text_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <regex>

#include "base/errors.h"
#include "base/parse_number.h"
#include "base/text_lines.h"

namespace microinjection {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kDay = 86400;         ///< s
constexpr std::size_t kLooked = 3000;  ///< lines that show how a table is written; a preamble is shorter

struct Cell {
  std::string text;
  bool quoted = false;
};
using Cells = std::vector<Cell>;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// Between blanks: runs of them count once. A quote within quotes is doubled (RFC 4180).
Cells split(const std::string& line, char separator) {
  Cells cells(1);
  bool open = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    Cell& cell = cells.back();
    if (open && line[i] == '"' && line.compare(i, 2, "\"\"") == 0) {
      cell.text += line[i++];
    } else if (line[i] == '"' && (open || trimmed(cell.text).empty())) {
      cell.text = open ? cell.text : "";
      open = !open;
      cell.quoted = true;
    } else if (!open && (line[i] == separator || (separator == ' ' && line[i] == '\t'))) {
      if (separator != ' ' || !cell.text.empty()) cells.emplace_back();
    } else {
      cell.text += line[i];
    }
  }
  if (separator == ' ' && cells.size() > 1 && cells.back().text.empty()) cells.pop_back();
  for (Cell& cell : cells) {
    if (!cell.quoted) cell.text = trimmed(cell.text);
  }
  return cells;
}

/// Digits in threes, as 1,234,567.8 with the separator ',' and the sign '.'.
bool hasThousands(const std::string& text, char separator, char sign) {
  std::size_t i = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::size_t first = text.find(separator);
  if (first == std::string::npos || first == i || first > i + 3 || (text[i] == '0' && first == i + 1)) return false;
  while (i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]))) ++i;
  while (i < text.size() && text[i] == separator) {
    for (int digit = 1; digit <= 3; ++digit) {
      if (i + static_cast<std::size_t>(digit) >= text.size() ||
          !std::isdigit(static_cast<unsigned char>(text[i + static_cast<std::size_t>(digit)])))
        return false;
    }
    i += 4;
  }
  return i == text.size() || text[i] == sign;
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t i = 0; (i = text.find(from, i)) != std::string::npos; i += to.size())
    text.replace(i, from.size(), to);
}

/// With the minus sign of a keyboard; without the blanks and apostrophes between digits in threes.
std::string asTyped(std::string text, char sign) {
  if (text.find_first_not_of("0123456789.,+-eE") == std::string::npos) return text;
  replaceAll(text, "\u2212", "-");
  for (const char* mark : {" ", "\u00A0", "\u2009", "\u2019", "\u202F"}) replaceAll(text, mark, "'");
  if (hasThousands(text, '\'', sign)) text.erase(std::remove(text.begin(), text.end(), '\''), text.end());
  return text;
}

std::optional<double> numberIn(std::string text, char sign) {
  text = asTyped(std::move(text), sign);
  const char other = sign == '.' ? ',' : '.';
  if (hasThousands(text, other, sign)) text.erase(std::remove(text.begin(), text.end(), other), text.end());
  if (text.find(other) != std::string::npos) return std::nullopt;
  std::replace(text.begin(), text.end(), ',', '.');
  if (!text.empty() && text[0] == '+') text.erase(0, 1);
  return parseNumber<double>(text);
}

/// s since midnight, or since 1970 with a date that begins with the year.
std::optional<double> clockIn(const std::string& text) {
  static const std::regex pattern(
      R"((?:(?:(\d{4})-(\d{1,2})-(\d{1,2})|\d{1,4}[-./]\d{1,2}[-./]\d{1,4}),?[T ])?)"
      R"((\d{1,2}):(\d{2})(?::(\d{2}(?:[.,]\d+)?))?(?: ?([AaPp])[Mm])?(?:Z|[+-]\d{2}:?\d{2})?)");
  static const std::regex minutes(R"((\d{1,3}):(\d{2}[.,]\d+))");
  std::smatch match;
  if (text.find(':') == std::string::npos) return std::nullopt;
  if (std::regex_match(text, match, minutes))
    return 60 * std::stoi(match[1].str()) + *numberIn(match[2].str(), match[2].str()[2]);
  if (!std::regex_match(text, match, pattern)) return std::nullopt;
  const auto part = [&](int i) { return match[i].matched ? std::stoi(match[i].str()) : 0; };
  std::string seconds = match[6].matched ? match[6].str() : "0";
  std::replace(seconds.begin(), seconds.end(), ',', '.');
  double days = 0;
  if (match[1].matched) {  // of the proleptic Gregorian calendar
    const int year = part(1) - (part(2) <= 2 ? 1 : 0), era = year / 400, of_era = year - 400 * era;
    const int of_year = (153 * (part(2) + (part(2) > 2 ? -3 : 9)) + 2) / 5 + part(3) - 1;
    days = 146097.0 * era + 365.0 * of_era + of_era / 4 - of_era / 100 + of_year - 719468;
  }
  const bool by_halves = match[7].matched, is_afternoon = by_halves && std::tolower(match[7].str()[0]) == 'p';
  const int hour = by_halves ? part(4) % 12 + (is_afternoon ? 12 : 0) : part(4);
  return kDay * days + 3600 * hour + 60 * part(5) + parseNumber<double>(seconds).value_or(0);
}

bool isMissing(const std::string& text) {
  static const char* const kWords[] = {"nan", "na", "n/a", "-", "--", "null", "none", "inf", "-inf", "#n/a"};
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::any_of(std::begin(kWords), std::end(kWords), [&](const char* word) { return lower == word; });
}

/// Whether it may be a number, whichever the decimal sign is.
bool mayBeNumber(const std::string& text) {
  return numberIn(text, '.') || numberIn(text, ',') || clockIn(text) || isMissing(text);
}

bool isBlank(const std::string& line) { return trimmed(line).empty(); }
/// The text of a comment, without its sign.
std::optional<std::string> commentIn(const std::string& line) {
  const std::string text = trimmed(line);
  if (!text.empty() && (text[0] == '#' || text[0] == '%'))
    return trimmed(text.substr(std::min(text.find_first_not_of("#%"), text.size())));
  if (text.rfind("//", 0) == 0) return trimmed(text.substr(2));
  return std::nullopt;
}

class TableReader {
 public:
  TableReader(const std::string& path, int least_numbers) : least_numbers_(least_numbers) {
    table_.path = path;
    lines_ = readTextLines(path, table_.notes);
  }

  TextTable read() {
    findRows();
    findTitles();
    chooseDecimalSign();
    readRows();
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(std::size_t index, const std::string& text) const {
    throw ConfigError(table_.path + ", line " + std::to_string(index + 1) + ": " + text);
  }
  bool isSkipped(std::size_t i) const { return isBlank(lines_[i]) || commentIn(lines_[i]).has_value(); }
  Cells cellsOf(std::size_t i) const { return split(lines_[i], separator_); }

  struct Count {
    int numbers = 0, texts = 0;
  };
  static Count countIn(const Cells& cells) {
    Count count;
    for (const Cell& cell : cells) {
      if (!cell.text.empty()) ++(mayBeNumber(cell.text) ? count.numbers : count.texts);
    }
    return count;
  }
  bool isRow(const Cells& cells) const { return countIn(cells).numbers >= least_numbers_; }

  /// The separator and the number of cells with which there are the most numbers.
  void findRows() {
    std::map<char, std::map<std::size_t, int>> counts;
    std::string said = lines_.empty() ? "" : lines_.front();
    std::transform(said.begin(), said.end(), said.begin(), [](unsigned char c) { return std::tolower(c); });
    if (said.size() == 5 && said.rfind("sep=", 0) == 0) {
      said_separator_ = true;
      separator_ = lines_.front()[4];
    }
    int most = 0;
    const std::string separators = said_separator_ ? std::string(1, separator_) : ";\t, ";
    for (const char separator : separators) {
      for (std::size_t i = said_separator_ ? 1 : 0, looked = 0; i < lines_.size() && looked < kLooked; ++i) {
        if (isSkipped(i)) continue;
        ++looked;
        const Cells cells = split(lines_[i], separator);
        const Count found = countIn(cells);
        if (found.numbers < least_numbers_) continue;
        const int least = least_numbers_ > 1 ? 0 : 1;  // texts are meant then
        const int count = counts[separator][cells.size()] += std::max(least, found.numbers - found.texts);
        if (count <= most) continue;
        most = count;
        width_ = cells.size();
        separator_ = separator;
      }
    }
    if (most == 0) fail(lines_.empty() ? 0 : firstText(), notATable());
    first_ = firstRow();
    table_.first_line = first_ + 1;
    std::size_t before = 0;
    for (std::size_t i = said_separator_ ? 1 : 0; i < first_; ++i) {
      const Cells cells = isSkipped(i) ? Cells() : cellsOf(i);
      if (cells.size() == width_ && isRow(cells)) ++before;
    }
    if (before > 0)
      table_.notes.push_back("the table begins in line " + std::to_string(table_.first_line) + ": " +
                             std::to_string(before) + " rows of numbers before it are left out");
  }
  /// A preamble may have lines that look like rows: the table's rows are the most behind one line of texts.
  std::size_t firstRow() const {
    std::size_t first = 0, rows = 0, most = 0, best = 0;  // first: behind the last line of texts
    for (std::size_t i = said_separator_ ? 1 : 0; i < lines_.size(); ++i) {
      if (isSkipped(i)) continue;
      const Cells cells = cellsOf(i);
      if (cells.size() == width_ && isRow(cells)) {
        if (++rows == 1) first = i;
        if (rows > most) most = rows, best = first;
      } else if (countIn(cells).numbers == 0) {
        rows = 0;
      }
      if (most > kLooked) break;
    }
    // The same titles again are of a further part.
    const std::size_t title = lineBefore(best);
    for (std::size_t i = 0; title < best && i < title; ++i) {
      if (lines_[i] == lines_[title]) return rowBehind(i);
    }
    return best;
  }
  /// The last line before a row that is not blank; the row itself when there is none.
  std::size_t lineBefore(std::size_t row) const {
    std::size_t i = row;
    while (i > 0 && isBlank(lines_[i - 1])) --i;
    return i > 0 ? i - 1 : row;
  }
  std::size_t rowBehind(std::size_t i) const {
    do ++i;
    while (isSkipped(i) || cellsOf(i).size() != width_ || !isRow(cellsOf(i)));
    return i;
  }
  std::size_t firstText() const {
    std::size_t i = 0;
    while (i + 1 < lines_.size() && isBlank(lines_[i])) ++i;
    return i;
  }
  std::string notATable() const {
    if (lines_.empty()) return "the file is empty";
    return "'" + shown(lines_[firstText()]) + "': the file has no row with " +
           (least_numbers_ > 1 ? "two numbers" : "a number") +
           "; it must be a table of numbers between commas, semicolons, tabs or "
           "blanks";
  }
  static std::string shown(const std::string& text) { return text.size() > 60 ? text.substr(0, 57) + "..." : text; }

  /// Cells of a line of titles. Between blanks "Time (s)" is one.
  std::vector<std::string> titlesIn(const std::string& line) const {
    std::vector<std::string> titles;
    for (const Cell& cell : split(line, separator_)) {
      std::string text = cell.text;
      replaceAll(text, "\u00A0", " ");
      const bool goes_on =
          separator_ == ' ' && !titles.empty() && !cell.text.empty() &&
          (cell.text[0] == '(' || cell.text[0] == '[' || cell.text[0] == '/' || titles.back().back() == '/');
      if (goes_on) {
        titles.back() += " " + text;
      } else {
        titles.push_back(trimmed(text));
      }
    }
    if (titles.size() > width_ && titles.back().empty()) titles.pop_back();
    // Each row, but not the titles, ends with a separator.
    if (separator_ != ' ' && titles.size() + 1 == width_ && cellsOf(first_).back().text.empty()) titles.emplace_back();
    return titles;
  }
  static bool isUnit(const std::string& text) {
    static const std::regex pattern(
        R"([\[(]?\s*(|[munpfkM]|µ|μ)(s|m|N|V|Pa|A|Hz|g|rad|deg)\s*[\])]?|[\[(]?[%a]\.?u?\.?[\])]?|[\[(]?-?[\])]?)");
    return std::regex_match(text, pattern);
  }

  /// Whether cells between commas are what is before and behind a decimal comma: 03518 is no number of its own.
  bool hasHalvesOfNumbers() const {
    bool found = false;
    for (std::size_t i = first_; separator_ == ',' && i < lines_.size() && i < first_ + kLooked; ++i) {
      if (isSkipped(i)) continue;
      if (lines_[i].find('.') != std::string::npos) return false;
      for (const Cell& cell : cellsOf(i)) {
        const bool digits = cell.text.find_first_not_of("0123456789") == std::string::npos;
        found = found || (digits && cell.text.size() > 1 && cell.text[0] == '0');
      }
    }
    return found;
  }
  [[noreturn]] void failForTwoCommas(std::size_t index, const std::string& found) const {
    fail(index, found + "a comma cannot be the separator and the decimal sign, but in quotes: '" +
                    shown(lines_[first_]) + "'");
  }

  void findTitles() {
    std::vector<std::size_t> above;  // the nearest first
    for (std::size_t i = first_; i-- > (said_separator_ ? 1 : 0);) {
      if (isBlank(lines_[i]) || commentIn(lines_[i]).value_or("-").empty()) continue;
      if (table_.before.empty() && !commentIn(lines_[i])) table_.before = lines_[i];
      above.push_back(i);
    }
    const auto has_names = [](const std::vector<std::string>& titles) {
      return std::any_of(titles.begin(), titles.end(), [](const std::string& title) {
        return std::any_of(title.begin(), title.end(), [](unsigned char c) { return std::isalpha(c); });
      });
    };
    std::vector<std::string> units;
    const bool has_halves = hasHalvesOfNumbers();
    for (std::size_t k = 0; k < above.size() && k < 3; ++k) {
      static const std::regex label("^(columns|channels|fields|units)\\s*:\\s*", std::regex::icase);
      const std::optional<std::string> comment = commentIn(lines_[above[k]]);
      const std::vector<std::string> titles =
          titlesIn(comment ? std::regex_replace(*comment, label, "") : lines_[above[k]]);
      const bool is_half = separator_ == ',' && 2 * titles.size() == width_;
      if (has_names(titles) && (is_half || (has_halves && titles.size() > 1 && titles.size() < width_)))
        failForTwoCommas(above[k], "has " + std::to_string(titles.size()) + " cells, the rows have " +
                                       std::to_string(width_) + ": ");
      if (titles.size() != width_ || !has_names(titles)) break;
      if (units.empty() && std::all_of(titles.begin(), titles.end(), isUnit)) {
        units = titles;
        continue;
      }
      table_.title_line = above[k] + 1;
      for (std::size_t c = 0; c < width_; ++c) {
        table_.columns.push_back({});
        table_.columns.back().title = titles[c];
        if (!units.empty()) table_.columns.back().unit = units[c];
      }
      if (commentIn(lines_[above[k]])) table_.notes.emplace_back("the titles are those of the last comment");
      return;
    }
    if (has_halves) failForTwoCommas(first_, "");
    table_.columns.resize(width_);
  }

  void eachRow(const std::function<void(std::size_t, const Cells&)>& use) {
    std::size_t last = lines_.size();
    while (last > first_ && isSkipped(last - 1)) --last;
    for (std::size_t i = first_; i < last; ++i) {
      if (isSkipped(i)) continue;
      const Cells cells = cellsOf(i);
      if (table_.title_line > 0 && lines_[i] == lines_[table_.title_line - 1]) {
        use(i, {});
      } else if (cells.size() == width_) {
        use(i, cells);
      } else if (i + 1 == last && cells.size() < width_) {
        cut_off_ = i + 1;
      } else {
        std::string text = "has " + std::to_string(cells.size()) + " cells, the table has " + std::to_string(width_);
        if (separator_ == ',' && cells.size() > width_)
          text += "; a comma is the separator here, and cannot be the decimal sign, too, but in quotes";
        fail(i, text + ": '" + shown(lines_[i]) + "'");
      }
    }
  }

  /// Of a column: the last number as 1,234, whose sign may be of decimals or of thousands, and what tells.
  struct InThrees {
    std::string text;
    double most_first = 0;  ///< before the sign
    double most_plain = 0;  ///< of the numbers without a sign

    /// 7,000 in a column with 990 is no 7: its decimals would not all be three or none.
    bool areThousands() const { return !text.empty() && most_plain >= 100 && most_plain > 2 * most_first; }
  };

  /// The sign that the numbers have. Digits in threes may be either: others tell.
  void chooseDecimalSign() {
    std::size_t points = 0, commas = 0, unclear = 0;
    std::vector<InThrees> in_threes(width_);
    eachRow([&](std::size_t i, const Cells& cells) {
      for (std::size_t c = 0; c < cells.size(); ++c) {
        const Cell& cell = cells[c];
        if (cell.text.find_first_of(".,") == std::string::npos) {
          in_threes[c].most_plain = std::max(in_threes[c].most_plain, std::abs(numberIn(cell.text, '.').value_or(0)));
          continue;
        }
        const bool by_point = numberIn(cell.text, '.').has_value(), by_comma = numberIn(cell.text, ',').has_value();
        if (by_point && by_comma) {
          unclear = i + 1;
          in_threes[c].text = cell.text;
          const std::string first = cell.text.substr(0, cell.text.find_first_of(".,"));
          in_threes[c].most_first = std::max(in_threes[c].most_first, std::abs(numberIn(first, '.').value_or(0)));
        }
        if (by_point && !by_comma && points == 0) points = i + 1;
        if (by_comma && !by_point && commas == 0) commas = i + 1;
      }
    });
    if (points > 0 && commas > 0)
      fail(std::max(points, commas) - 1, "the decimal sign is another one than in line " +
                                             std::to_string(std::min(points, commas)) + ": '" +
                                             shown(lines_[std::max(points, commas) - 1]) + "'");
    const bool is_unclear = points == 0 && commas == 0 && unclear > 0;
    for (const InThrees& column : in_threes) {
      if (!is_unclear || !column.areThousands()) continue;
      sign_ = column.text.find(',') != std::string::npos ? '.' : ',';
      table_.notes.push_back("'" + column.text + "' is taken for a number with a separator of thousands");
      return;
    }
    for (const InThrees& column : in_threes) {
      const bool has_comma = column.text.find(',') != std::string::npos;
      if (is_unclear && has_comma && (separator_ == ',' || column.most_plain > 0))
        fail(unclear - 1, "'" + column.text +
                              "': the comma may be the decimal sign, or separate thousands: must be one " +
                              "that other numbers show");
    }
    if (is_unclear && lines_[unclear - 1].find(',') != std::string::npos &&
        lines_[unclear - 1].find('.') == std::string::npos && separator_ != ',')
      commas = unclear;
    sign_ = commas > 0 ? ',' : '.';
    if (commas > 0) table_.notes.emplace_back("the decimal sign is a comma");
  }

  void readRows() {
    eachRow([this](std::size_t i, const Cells& cells) {
      if (cells.empty()) {
        table_.parts.push_back(table_.rows());
        return;
      }
      for (std::size_t c = 0; c < width_; ++c) add(table_.columns[c], cells[c].text, i);
    });
    if (cut_off_ > 0)
      table_.notes.push_back("line " + std::to_string(cut_off_) + ", the last one, is cut off and left out");
    for (TextTable::Column& column : table_.columns) {
      startClock(column);
      if (!column.texts.empty()) column.texts.resize(column.values.size());
    }
    if (table_.columns.back().numbers == 0 && table_.columns.back().text.empty() &&
        table_.columns.back().title.empty() && width_ > 1)
      table_.columns.pop_back();  // each line ends with a separator
  }

  void add(TextTable::Column& column, const std::string& text, std::size_t line) {
    std::optional<double> value = text.empty() || isMissing(text) ? std::nullopt : numberIn(text, sign_);
    if (!value && !text.empty() && !isMissing(text)) {
      value = clockIn(text);
      column.clock = column.clock || value.has_value();
      if (!value && column.text.empty()) {
        column.text = text;
        column.text_line = line + 1;
      }
      if (!value) {
        column.texts.resize(column.values.size());
        column.texts.push_back(text);
      }
    }
    column.values.push_back(value.value_or(kNoNumber));
    if (value) ++column.numbers;
  }

  /// From the first time on, over midnight, too.
  static void startClock(TextTable::Column& column) {
    if (!column.clock) return;
    double first = kNoNumber, before = kNoNumber, days = 0;
    for (double& value : column.values) {
      if (!std::isfinite(value)) continue;
      if (value + days < before - kDay / 2) days += kDay;
      before = value + days;
      if (!std::isfinite(first)) first = before;
      value = before - first;
    }
  }

  int least_numbers_;
  TextTable table_;
  std::vector<std::string> lines_;
  bool said_separator_ = false;
  char separator_ = ',', sign_ = '.';
  std::size_t width_ = 0, first_ = 0, cut_off_ = 0;
};

}  // namespace

std::vector<std::string> TextTable::titles() const {
  std::vector<std::string> titles;
  for (const Column& column : columns)
    titles.push_back(column.unit.empty() ? column.title : column.title + " (" + column.unit + ")");
  return titles;
}

TextTable readTextTable(const std::string& path, int least_numbers) { return TableReader(path, least_numbers).read(); }

}  // namespace microinjection
