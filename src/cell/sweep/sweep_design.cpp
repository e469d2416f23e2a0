#include "cell/sweep/sweep_design.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <set>

namespace microinjection {
namespace {

constexpr std::size_t kMostTasks = 10'000'000;

std::string text(double value) {
  char number[32];
  std::snprintf(number, sizeof number, "%.9g", value);
  return number;
}

/// The value at a share in [0, 1] of the range.
double at(const SweptKey& key, double share) {
  if (key.logarithmic) return key.from * std::pow(key.to / key.from, share);
  return key.from + share * (key.to - key.from);
}

void readRange(ConfigReader& reader, bool random, SweptKey& key) {
  constexpr auto kRequired = ConfigReader::kRequired;
  std::string scale = "linear";
  int count = 2;
  reader.number("from", key.from, Range::finite(), kRequired);
  reader.number("to", key.to, Range::finite(), kRequired);
  reader.choice("scale", scale, {"linear", "log"});
  if (!random) reader.integer("count", count, Range::closed(2, 1e6), kRequired);
  key.logarithmic = scale == "log";
  if (key.logarithmic && !(key.from > 0 && key.to > 0)) {
    reader.error("scale", "needs from and to above 0");
    return;
  }
  for (int i = 0; !random && i < count; ++i) {
    key.values.push_back(text(i == count - 1 ? key.to : at(key, static_cast<double>(i) / (count - 1))));
  }
}

SweptKey readKey(ConfigReader& reader, bool random) {
  SweptKey key;
  reader.text("key", key.key, ConfigReader::kRequired);
  if (reader.has("values")) {
    reader.texts("values", key.values);
  } else {
    readRange(reader, random, key);
  }
  return key;
}

/// In [0, 1). The standard fixes the generator's numbers, but not those of its distributions.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

}  // namespace

SweepDesign SweepDesign::read(ConfigReader& reader) {
  SweepDesign design;
  std::string kind = "grid";
  int samples = 0;
  reader.choice("design", kind, {"grid", "random"});
  design.random_ = kind == "random";
  if (design.random_) {
    reader.integer("samples", samples, Range::closed(1, static_cast<double>(kMostTasks)), ConfigReader::kRequired);
    reader.integer("seed", design.seed_, Range::closed(0, std::numeric_limits<int>::max()));
  }
  std::set<std::string> seen;
  design.size_ = design.random_ ? static_cast<std::size_t>(samples) : 1;
  for (ConfigReader& each : reader.sections("keys", ConfigReader::kRequired)) {
    const SweptKey& key = design.keys_.emplace_back(readKey(each, design.random_));
    if (!seen.insert(key.key).second) each.error("key", "is there twice");
    if (!design.random_ && design.size_ <= kMostTasks) design.size_ *= std::max<std::size_t>(1, key.values.size());
  }
  if (design.size_ > kMostTasks)
    reader.error("keys", "make more than " + std::to_string(kMostTasks) + " tasks; must be fewer");
  if (design.keys_.empty()) reader.error("keys", "must name at least one key");
  return design;
}

std::vector<std::string> SweepDesign::values(std::size_t task) const {
  std::vector<std::string> result(keys_.size());
  if (!random_) {
    for (std::size_t i = keys_.size(); i-- > 0;) {
      const std::vector<std::string>& values = keys_[i].values;
      result[i] = values[task % values.size()];
      task /= values.size();
    }
    return result;
  }
  std::seed_seq seed{static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(task)};
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const SweptKey& key = keys_[i];
    const double share = uniform(random);
    const auto index = static_cast<std::size_t>(share * static_cast<double>(key.values.size()));
    result[i] = key.values.empty() ? text(at(key, share)) : key.values[index];
  }
  return result;
}

}  // namespace microinjection
