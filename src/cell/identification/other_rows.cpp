#include "cell/identification/other_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <set>

#include "base/errors.h"
#include "base/lower_case.h"
#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr std::size_t kShown = 60;  ///< characters of a list, about

/// Of a column of texts, numbers or both.
std::vector<std::string> textsOf(const TextTable::Column& column) {
  std::vector<std::string> texts = column.texts;
  texts.resize(column.values.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!std::isfinite(column.values[i])) continue;
    char text[40];
    std::snprintf(text, sizeof(text), "%g", column.values[i]);
    texts[i] = text;
  }
  return texts;
}

/// A row from 1, or a time in s.
bool isWithin(const std::string& option, const std::string& limit, std::size_t row, double time, bool from) {
  const bool is_time = !limit.empty() && limit.back() == 's';
  const auto value = parseNumber<double>(is_time ? limit.substr(0, limit.size() - 1) : limit);
  if (!value || !std::isfinite(*value) || (!is_time && (*value < 1 || *value != std::floor(*value))))
    throw ConfigError(option + " = " + limit + ": must be a row from 1, as 120, or a time, as 1.5s");
  const double at = is_time ? time : static_cast<double>(row + 1);
  return from ? at >= *value : at <= *value;
}

}  // namespace

OtherRows::OtherRows(const TextTable& table, const ForceCurveConfig& config) : config_(config) {
  for (const TextTable::Column& column : table.columns) {
    const std::string title = lowerCase(column.title);
    if (title == "segment") segments_ = textsOf(column);
    if (title == "punctured" || title == "layers_punctured") punctured_ = &column.values;
  }
  if (segments_.empty()) {
    if (!config.segment.empty())
      throw ConfigError(table.path + ": --segment = " + config.segment + ": the table has no column 'segment'");
    return;
  }
  has_used_ =
      std::any_of(segments_.begin(), segments_.end(), [this](const std::string& segment) { return isUsed(segment); });
  if (!has_used_ && !config.segment.empty()) {
    std::string all;
    for (const std::string& each : std::set<std::string>(segments_.begin(), segments_.end())) {
      if (!each.empty() && all.size() < kShown) all += (all.empty() ? "" : ", ") + each;
    }
    throw ConfigError(table.path + ": --segment = " + config.segment + ": the column 'segment' has no such text, but " +
                      all);
  }
}

bool OtherRows::has(std::size_t row, double time) {
  if (!config_.from.empty() && !isWithin("--from", config_.from, row, time, true)) return ++outside_ > 0;
  if (!config_.to.empty() && !isWithin("--to", config_.to, row, time, false)) return ++outside_ > 0;
  if (config_.whole) return false;
  if (has_used_ && !isUsed(segments_[row])) return ++of_segments_ > 0;
  is_behind_ = is_behind_ || (punctured_ && (*punctured_)[row] > 0);
  return is_behind_ && ++behind_ > 0;
}

void OtherRows::tell(std::vector<std::string>& notes) const {
  if (outside_ > 0) notes.push_back(std::to_string(outside_) + " rows outside of --from and --to are left out");
  if (of_segments_ > 0)
    notes.push_back(std::to_string(of_segments_) + " rows of other segments than " +
                    (config_.segment.empty() ? "the approach" : config_.segment) + " are left out");
  if (behind_ > 0) notes.push_back("the " + std::to_string(behind_) + " rows from the puncture on are left out");
}

bool OtherRows::isUsed(const std::string& segment) const {
  if (!config_.segment.empty()) return lowerCase(segment) == lowerCase(config_.segment);
  static const char* const kWords[] = {"approach", "extend", "extension", "trace", "loading",
                                       "load",     "indent", "forward",   "in"};
  const std::string word = lowerCase(segment);
  return std::any_of(std::begin(kWords), std::end(kWords), [&](const char* each) { return word == each; });
}

}  // namespace microinjection
