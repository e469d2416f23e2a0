#include "operation/teleoperation/hand_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <random>

#include "base/config_reader.h"
#include "base/errors.h"
#include "base/separated.h"

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

/// Generates the motion of a hand with 200 samples a second. The paths between waypoints have
/// minimum jerk, as human reaching has (Flash and Hogan 1985). A physiological tremor of 8 to 12 Hz
/// is added; it fades in and out over the first and the last half second.
///
/// Keys:
///   tremor/rms   m, on each axis; default 0, in [0, inf)
///   tremor/seed  default 1
///   path         list of waypoints in order, from position 0: `duration` (s) of the path to it,
///                `z` (m, haptic device, negative towards the cell), `clutch` (pressed on that
///                path; default false), `phase` (text for people)
/// @throws ConfigError
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

constexpr char kHeader[] = "time_s,x_m,y_m,z_m,clutch,phase";

double toNumber(const std::string& text, const std::string& where) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !(std::abs(value) < 1e9)) {
    throw ConfigError(where + ": \"" + text + "\" must be a finite number");
  }
  return value;
}

HandMotion::Sample toSample(const std::string& line, const std::string& where) {
  const std::vector<std::string> cells = separated(line);
  if (cells.size() != 6) throw ConfigError(where + ": must have six cells: " + kHeader);
  if (cells[4] != "0" && cells[4] != "1") throw ConfigError(where + ": clutch = " + cells[4] + ", must be 0 or 1");
  HandMotion::Sample sample;
  sample.time = toNumber(cells[0], where);
  for (int i = 0; i < 3; ++i) sample.position[i] = toNumber(cells[1 + i], where);
  sample.clutch = cells[4] == "1";
  sample.phase = cells[5];
  return sample;
}

}  // namespace

HandMotion HandMotion::load(const std::string& path) {
  const std::string ending = path.substr(std::min(path.find_last_of('.'), path.size()));
  if (ending == ".yaml" || ending == ".yml") {
    return HandMotion(generateMotion(ConfigReader(loadYamlMap(path), path)));
  }
  std::ifstream file(path);
  if (!file) throw ConfigError(path + ": cannot be read");
  std::vector<Sample> samples;
  bool header = false;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const std::string where = path + ":" + std::to_string(number);
    if (!header && line != kHeader) throw ConfigError(where + ": header must be " + kHeader);
    if (header) samples.push_back(toSample(line, where));
    header = true;
  }
  try {
    return HandMotion(std::move(samples));
  } catch (const ConfigError& error) {
    throw ConfigError(path + ": " + error.what());
  }
}

HandMotion::HandMotion(std::vector<Sample> samples) : samples_(std::move(samples)) {
  if (samples_.size() < 2) throw ConfigError("hand motion must have at least two samples");
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    if (samples_[i].time <= samples_[i - 1].time) {
      throw ConfigError("hand motion: time_s = " + std::to_string(samples_[i].time) + " must be later than " +
                        std::to_string(samples_[i - 1].time) + " before it");
    }
  }
}

HandMotion::Sample HandMotion::at(double time) const {
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), time,
                                      [](double t, const Sample& sample) { return t < sample.time; });
  if (after == samples_.begin()) return samples_.front();
  if (after == samples_.end()) return samples_.back();
  const Sample& before = *(after - 1);
  Sample result = before;
  const double share = (time - before.time) / (after->time - before.time);
  result.time = time;
  result.position = before.position + share * (after->position - before.position);
  return result;
}

}  // namespace microinjection
