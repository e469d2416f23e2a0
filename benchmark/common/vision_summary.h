#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/common/vision_row.h"

namespace microinjection {

/// "1.234" by the pattern of printf, or nothing for a number that there is not.
std::string numberText(double value, const char* pattern);

/// Counts rows by set and by what they measure. Rows of real images (with a group) count for their set's and for their
/// totals, too.
class VisionSummary {
 public:
  void add(const VisionRow& row);
  void print() const;

 private:
  /// Errors, and what intervals cover, are those of what was found without a warning.
  struct Count {
    std::vector<double> errors, times;
    int images = 0, found = 0, sure = 0, wrong = 0, limited = 0, right = 0, stated = 0, covered = 0;

    void add(const VisionRow& row);
  };
  static void printLine(const std::string& set, const std::string& what, const Count& count);

  std::map<std::pair<std::string, std::string>, Count> counts_;
};

}  // namespace microinjection
