#pragma once

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <vector>

namespace microinjection {

/// s, of CPU, of the whole process: what a library's threads do counts.
inline double processTime() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The value below which this share of all lies; nan of none.
inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// CPU times of call(i), i = 0, 1, ..., us: of one call, or of a batch of quick ones over its size,
/// since asking for the time takes a fraction of a microsecond. Until there are `samples` or
/// `seconds` are over, but `least` in any case.
template <typename Call>
std::vector<double> callTimes(const Call& call, int batch, std::size_t samples, double seconds, std::size_t least = 1) {
  std::vector<double> times;
  int i = 0;
  const double begin = processTime();
  while (times.size() < least || (times.size() < samples && processTime() < begin + seconds)) {
    const double start = processTime();
    for (int k = 0; k < batch; ++k) call(i++);
    times.push_back(1e6 * (processTime() - start) / batch);
  }
  return times;
}

}  // namespace microinjection
