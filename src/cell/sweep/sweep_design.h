#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/config_reader.h"

namespace microinjection {

/// A key of the scene file that a sweep varies.
struct SweptKey {
  std::string key;                  ///< path, as cell/material/young_modulus or cell/layers/0/thickness
  std::vector<std::string> values;  ///< as they stand in the file; empty: a random design draws from the range
  double from = 0, to = 0;          ///< the range's ends, in the key's unit
  bool logarithmic = false;         ///< steps and draws are even in the logarithm
};

/// Which values the keys of each task have. Tasks are numbered from 0. A task's values depend on the
/// design and its number only, so that any machine may compute it.
class SweepDesign {
 public:
  /// Reads `design` (grid or random), `samples`, `seed` and `keys`. Errors stay in the reader.
  static SweepDesign read(ConfigReader& reader);

  std::size_t size() const { return size_; }  ///< number of tasks
  const std::vector<SweptKey>& keys() const { return keys_; }
  /// Values of keys() as text. In a grid the last key changes fastest.
  std::vector<std::string> values(std::size_t task) const;

 private:
  bool random_ = false;
  int seed_ = 1;
  std::size_t size_ = 0;
  std::vector<SweptKey> keys_;
};

}  // namespace microinjection
