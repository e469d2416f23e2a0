#pragma once

#include <vector>

namespace microinjection {

/// The middle of the sorted values, and of two middle ones the larger; 0 for none.
double upperMedian(std::vector<double> values);
/// The middle of the sorted values, and of two middle ones their mean. @pre not empty
double medianOf(std::vector<double> values);

}  // namespace microinjection
