#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/text_table.h"
#include "cell/identification/force_curve.h"

namespace microinjection {

/// Rows that are none of the way in by the record's own words, or the user's: of another segment, outside of what is
/// asked for, behind a puncture.
class OtherRows {
 public:
  /// The table must outlive it. @throws ConfigError when the table has no segment of the configuration's name.
  OtherRows(const TextTable& table, const ForceCurveConfig& config);

  /// Whether a row, asked for one after the other, is such a one; `time`: s, of the row.
  bool has(std::size_t row, double time);

  /// How many were left out, and why.
  void tell(std::vector<std::string>& notes) const;

 private:
  bool isUsed(const std::string& segment) const;

  std::vector<std::string> segments_;  ///< one for each row; empty: there is no such column
  const std::vector<double>* punctured_ = nullptr;
  ForceCurveConfig config_;
  bool has_used_ = false, is_behind_ = false;
  std::size_t outside_ = 0, of_segments_ = 0, behind_ = 0;
};

}  // namespace microinjection
