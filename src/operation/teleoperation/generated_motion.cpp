#include "operation/teleoperation/generated_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace microinjection {
namespace {

constexpr double kRate = 200;  // Hz
constexpr double kFade = 0.5;  // s
constexpr int kSines = 6;      // of the tremor

struct Waypoint {
  double duration = 0;  // s
  double z = 0;         // m
  bool clutch = false;
  std::string phase;
};

std::vector<Waypoint> readPath(ConfigReader& reader) {
  std::vector<Waypoint> path;
  for (ConfigReader& section : reader.sections("path", ConfigReader::kRequired)) {
    Waypoint& waypoint = path.emplace_back();
    section.number("duration", waypoint.duration, Range::closed(1 / kRate, 3600), ConfigReader::kRequired);
    section.number("z", waypoint.z, Range::closed(-1, 1), ConfigReader::kRequired);
    section.boolean("clutch", waypoint.clutch);
    section.text("phase", waypoint.phase, ConfigReader::kRequired);
  }
  return path;
}

double minimumJerk(double share) { return share * share * share * (10 - 15 * share + 6 * share * share); }

/// Sum of a few sines between 8 and 12 Hz.
class Tremor {
 public:
  Tremor(double rms, int seed) : amplitude_(rms / std::sqrt(kSines / 2.0)) {
    std::mt19937_64 random(seed);
    // std::uniform_real_distribution gives different numbers with each standard library.
    const auto share = [&random] { return static_cast<double>(random() >> 11) / static_cast<double>(1ULL << 53); };
    for (Sine& sine : sines_) {
      sine.frequency = 8 + 4 * share();
      for (int axis = 0; axis < 3; ++axis) sine.phase[axis] = 2 * M_PI * share();
    }
  }

  /// Displacement (m) at a time (s).
  Eigen::Vector3d at(double time) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Sine& sine : sines_) {
      sum.array() += (2 * M_PI * sine.frequency * time + sine.phase.array()).sin();
    }
    return amplitude_ * sum;
  }

 private:
  struct Sine {
    double frequency = 0;  // Hz
    Eigen::Vector3d phase = Eigen::Vector3d::Zero();
  };
  double amplitude_;
  std::array<Sine, kSines> sines_;
};

}  // namespace

std::vector<HandMotion::Sample> generateMotion(ConfigReader reader) {
  double rms = 0;
  int seed = 1;
  ConfigReader section = reader.section("tremor");
  section.number("rms", rms, Range::nonNegative());
  section.integer("seed", seed, Range::nonNegative());
  const std::vector<Waypoint> path = readPath(reader);
  if (reader.has("path") && path.empty()) reader.error("path", "must have a waypoint");
  reader.finish();

  std::vector<HandMotion::Sample> samples;
  double z = 0;
  const auto add = [&samples](double to, bool clutch, const std::string& phase) {
    samples.push_back({static_cast<double>(samples.size()) / kRate, {0, 0, to}, clutch, phase});
  };
  for (const Waypoint& waypoint : path) {
    const int count = std::max(1, static_cast<int>(std::lround(waypoint.duration * kRate)));
    for (int i = 0; i < count; ++i) {
      add(z + (waypoint.z - z) * minimumJerk(static_cast<double>(i) / count), waypoint.clutch, waypoint.phase);
    }
    z = waypoint.z;
  }
  add(z, false, path.back().phase);
  const Tremor tremor(rms, seed);
  const double end = samples.back().time;
  for (HandMotion::Sample& sample : samples) {
    const double fade = std::min({1.0, sample.time / kFade, (end - sample.time) / kFade});
    sample.position += fade * tremor.at(sample.time);
  }
  return samples;
}

}  // namespace microinjection
