// Motion of a cell as a whole: Stokes, rest, hold limits, rolling, energy, hard cases, order, time of a step; a
// pick-up's course.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/call_times.h"
#include "benchmark/common/printed_table.h"
#include "benchmark/common/suction_hold.h"
#include "cell/pose/cell_motion.h"

namespace microinjection {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // s

/// Rows of quantity, its condition, value, what it should be, and unit.
class Rows {
 public:
  Rows() { table_.add("quantity,at,value,expected,unit\n"); }
  void add(const std::string& quantity, double at, double value, double expected, const std::string& unit) {
    char row[200];
    std::snprintf(row, sizeof row, "%s,%.6g,%.6g,%.6g,%s\n", quantity.c_str(), at, value, expected, unit.c_str());
    table_.add(row);
  }
  const std::string& text() const { return table_.text(); }

 private:
  PrintedTable table_;
};

void run(CellMotion& motion, const CellMotionInput& input, int count) {
  for (int i = 0; i < count; ++i) motion.step(kStep, input);
}

void addStokes(Rows& rows) {
  CellMotionConfig config = withoutDish();
  CellMotion sinking(config, {}, {});
  run(sinking, {}, 100);
  rows.add("sinking_speed", NAN, -sinking.state().velocity.z(), config.weight() / config.drag(), "m/s");
  CellMotionInput twisted;
  twisted.torque = {0, 0, 1e-16};
  CellMotion turning(config, {}, {});
  run(turning, twisted, 100);
  rows.add("turning_speed", NAN, turning.state().angular_velocity.z(),
           1e-16 / (8 * M_PI * config.viscosity * std::pow(config.radius, 3)), "rad/s");
  const WallResistance table;
  for (const double gap : {1e-3, 1e-2, 0.1, 1.0, 10.0}) {
    const WallFactors fast = table.at(1.03 * gap), exact = wallSeries(1.03 * gap);
    rows.add("wall_perpendicular", 1.03 * gap, fast.perpendicular, exact.perpendicular, "");
    rows.add("wall_parallel", 1.03 * gap, fast.parallel, exact.parallel, "");
    rows.add("wall_coupling", 1.03 * gap, fast.coupling, exact.coupling, "");
    rows.add("wall_rolling", 1.03 * gap, fast.rolling, exact.rolling, "");
  }
}

void addRest(Rows& rows) {
  const CellMotionConfig config;
  CellMotion motion(config, {}, {});
  motion.place({0, 0, 60e-6}, Quaterniond::Identity(), {});
  run(motion, {}, 20000);
  const double stiffness = 4.0 / 3 * config.contactModulus() * std::sqrt(config.radius);
  rows.add("rest_indentation", NAN, -motion.state().dish_gap, std::pow(config.weight() / stiffness, 2.0 / 3), "m");
}

/// Ramps a load in hundredths of `expected` until the cell is no longer held.
double comesOff(CellMotion motion, CellMotionInput input, const Vector3d& direction, double expected, double* opens) {
  for (double share = 0.3; share < 1.5; share += 0.005) {
    input.force = share * expected * direction;
    run(motion, input, 100);
    if (opens && *opens == 0 && !motion.state().sealed) *opens = share * expected;
    const CellMode mode = motion.state().mode;
    if (mode != CellMode::kHeld && mode != CellMode::kSlipping) return share * expected;
  }
  return NAN;
}

void addHoldLimits(Rows& rows) {
  for (const double modulus : {8.26e3, 1e5, 1e7}) {
    CellMotionConfig config = withoutDish();
    config.modulus = modulus;
    config.density_difference = 0;
    config.friction.lip = 0;
    CellMotionInput input;
    CellMotion motion = placedBeforeMouth(config, input, -500);
    run(motion, input, 50);
    const double seal = heldMouth().touchRadius(config.radius);
    const HoldLimits limits(500 * M_PI * seal * seal, seal, config.radius, 0);  // of a rigid sphere
    double opens = 0;
    rows.add("pull_off", modulus, comesOff(motion, input, Vector3d::UnitX(), limits.suction(), nullptr),
             limits.suction(), "N");
    const double sideways = comesOff(motion, input, Vector3d::UnitY(), limits.sideways(), &opens);
    rows.add("sideways_off", modulus, sideways, limits.sideways(), "N");
    rows.add("sideways_opens", modulus, opens, limits.opening(), "N");
  }
}

/// A needle along the tube, beside its axis, until the cell turns in its seat.
void addSlip(Rows& rows, double beside) {
  CellMotionConfig config = withoutDish();
  config.density_difference = 0;
  config.friction.lip = 0.05;
  config.friction.needle = 2;
  CellMotionInput input;
  CellMotion motion = placedBeforeMouth(config, input, -2000);
  run(motion, input, 50);
  const double reach = config.radius + kHeldTip, from = std::sqrt(reach * reach - beside * beside) - kHeldTip,
               speed = 2e-6;
  input.needle = along(Vector3d::UnitX(), motion.state().position + Vector3d(from, beside, 0));
  for (int i = 0; i < 20000 && !(motion.state().lip.slips && motion.state().lip.sliding > speed / 2); ++i) {
    input.needle->position.x() -= kStep * speed;
    motion.step(kStep, input);
  }
  const Vector3d force = motion.state().needle.force;
  const Vector3d out = (input.needle->position + kHeldTip * Vector3d::UnitX() - motion.state().position).normalized();
  const Quaterniond own = input.mouth.orientation.conjugate();
  const double seal = heldMouth().touchRadius(config.radius);
  const HoldLimits limits(2000 * M_PI * seal * seal, seal, config.radius, config.friction.lip);  // of a rigid sphere
  rows.add("needle_slip", beside, force.norm(), limits.largest(own * (config.radius * out), own * force), "N");
}

/// Between a shaft that lies across and moves, and the dish.
void addRolling(Rows& rows) {
  CellMotionConfig config;
  config.friction.needle = 0.3;
  CellMotionInput input;
  const double travel = 6e-6, speed = 5e-6;
  input.needle = along(Vector3d::UnitY(), {-travel / 4, -500e-6, 2 * config.radius + kHeldTip});
  CellMotion motion(config, {}, RoundedTip(kHeldTip, kHeldTip));
  motion.place({0, 0, config.radius}, Quaterniond::Identity(), input);
  input.needle->position.z() -= 0.5e-6;
  run(motion, input, 50);
  const CellMotionState before = motion.state();
  for (double gone = 0; gone < travel; gone += kStep * speed) {
    input.needle->position.x() += kStep * speed;
    motion.step(kStep, input);
  }
  rows.add("rolled_way", NAN, (motion.state().position - before.position).x(), travel / 2, "m");
  rows.add("rolled_angle", NAN, motion.state().orientation.angularDistance(before.orientation),
           travel / (2 * config.radius), "rad");
}

/// Random motions of both tools and of the pressure: the largest excess of a step's energy over what the tools lend.
void addEnergy(Rows& rows) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto drawn = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  CellMotionInput input;
  input.mouth.position = {0, 0, 60e-6};
  CellMotion motion = placedBeforeMouth({}, input, -500);
  double largest = -1, work = 0;
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const double jump = i % 100 == 0 ? 50e-6 : 0.5e-6;
    input.mouth.position += 0.1 * jump * drawn() - 0.1 * (input.mouth.position - Vector3d(0, 0, 60e-6));
    const Vector3d centre = motion.state().position;
    const ToolPose last = input.needle.value_or(along(Vector3d::UnitX(), centre + Vector3d(45e-6, 0, 0)));
    input.needle = ToolPose{last.position + jump * drawn() + 0.02 * (centre + Vector3d(40e-6, 0, 0) - last.position),
                            last.orientation};
    if (i % 50 == 0) input.pressure = -500 + 500 * normal(random);
    const CellMotionEnergy energy = motion.step(kStep, input).energy;
    largest = std::max(largest, energy.rise + energy.viscous / 2 + energy.friction);
    work += std::abs(energy.work);
  }
  rows.add("energy_excess", count, largest, 0, "J");
  rows.add("mean_work_of_step", count, work / count, NAN, "J");
}

/// What becomes of a cell in a hard case, and the largest excess of a step's energy (as in addEnergy; nan: a number was
/// not finite).
template <typename Drive>
void addHardCase(Rows& rows, const std::string& what, CellMotion motion, CellMotionInput input, double seconds,
                 const Drive& drive) {
  double largest = -1, leak = 0;
  int slipping = 0;
  for (int i = 1; i * kStep <= seconds; ++i) {
    drive(i * kStep, input);
    const CellMotionState& state = motion.step(kStep, input);
    const double excess = state.energy.rise + state.energy.viscous / 2 + state.energy.friction;
    const bool finite = std::isfinite(excess) && state.position.allFinite() && state.velocity.allFinite();
    largest = finite && !state.refusal ? std::max(largest, excess) : NAN;
    if (!(largest > -INFINITY)) break;
    leak = std::max(leak, state.leak);
    slipping += state.mode == CellMode::kSlipping ? 1 : 0;
  }
  std::string outcome = name(motion.state().mode);
  if (motion.state().sealed) outcome += " sealed";
  if (slipping > 0) outcome += " after slipping for " + std::to_string(slipping) + " ms";
  rows.add("hard " + what + ": " + outcome, seconds, largest, 0, "J");
  rows.add("hard " + what + ": largest leak", seconds, leak, NAN, "m^3/s");
}

void addHardCases(Rows& rows) {
  const auto still = [](double, CellMotionInput&) {};
  CellMotionInput input;
  CellMotionConfig config = withoutDish();
  {
    const PipetteMouth wide(60e-6, 80e-6, 5e-6, 1);
    input.mouth.orientation = along(-Vector3d::UnitX(), Vector3d::Zero()).orientation;
    input.pressure = -50;
    CellMotion motion(config, wide, {});
    motion.place({30e-6, 5e-6, 0}, Quaterniond::Identity(), input);
    addHardCase(rows, "mouth wider than the cell", motion, input, 2, still);
  }
  for (const double area : {5e-12, 50e-12, 500e-12}) {
    CellMotionInput leaking;
    leaking.notch_area = area;
    const std::string size = std::to_string(std::lround(1e12 * area));
    const CellMotion motion = placedBeforeMouth(config, leaking, -500, 1e-6);
    addHardCase(rows, "lip with a notch of " + size + " um2", motion, leaking, 2, still);
  }
  const auto square = [](double time, CellMotionInput& at) {
    at.pressure = std::fmod(20 * time, 1) < 0.5 ? -2000 : 2000;
  };
  addHardCase(rows, "pressure reversed at 20 Hz, 2 kPa", placedBeforeMouth(config, input, -2000), input, 3, square);
  const auto steps = [](double time, CellMotionInput& at) {
    at.pressure = std::fmod(20 * time, 1) < 0.5 ? -2000 : -20;
  };
  addHardCase(rows, "pressure in steps at 20 Hz, 2 kPa and 20 Pa", placedBeforeMouth(config, input, -2000), input, 3,
              steps);
  for (const double beside : {0.25, 0.5, 0.75, 1.0}) {
    CellMotion motion = placedBeforeMouth(config, input, -500);
    const Vector3d on_lip(heldMouth().touchDistance(config.radius), beside * config.radius, 0);
    motion.place(on_lip, Quaterniond::Identity(), input);
    char what[60];
    std::snprintf(what, sizeof what, "cell on the lip, %.2g radii beside its axis", beside);
    addHardCase(rows, what, motion, input, 5, still);
  }
  config.friction.lip = 0.05;
  config.friction.needle = 2;
  CellMotion pushed = placedBeforeMouth(config, input, -2000);
  run(pushed, input, 50);
  const Vector3d touch = pushed.state().position + Vector3d(config.radius, 0, 0);
  const auto into = [&](double time, CellMotionInput& at) {
    at.needle = along(Vector3d::UnitX(), touch + Vector3d(-10e-6 * time, 25e-6, 0));
  };
  addHardCase(rows, "needle 25 um beside the axis, 30 um on", pushed, input, 3, into);
}

Vector3d afterSteps(int count) {
  CellMotionConfig config;
  CellMotionInput input;
  input.needle = along(Vector3d::UnitZ(), {5e-6, 0, 95e-6});
  CellMotion motion(config, {}, RoundedTip(kHeldTip, kHeldTip));
  motion.place({0, 0, 50e-6}, Quaterniond::Identity(), input);
  for (int i = 1; i <= count; ++i) {
    input.needle->position.z() = 95e-6 - 30e-6 * std::pow(static_cast<double>(i) / count, 2);
    motion.step(0.256 / count, input);
  }
  return motion.state().position;
}

void addOrder(Rows& rows) {
  const Vector3d exact = afterSteps(32768);
  for (const int count : {64, 128, 256, 512, 1024}) {
    rows.add("error_after_0.256_s", 0.256 / count, (afterSteps(count) - exact).norm(), 0, "m");
  }
}

void addTimes(Rows& rows) {
  const auto add = [&](const std::string& quantity, const std::vector<double>& times) {
    rows.add(quantity + "_median", NAN, quantile(times, 0.5), NAN, "us");
    rows.add(quantity + "_99_percent", NAN, quantile(times, 0.99), NAN, "us");
  };
  CellMotionConfig config;
  CellMotionInput input;
  CellMotion free(config, {}, {});
  free.place({0, 0, 1}, Quaterniond::Identity(), input);
  add("time_free", callTimes([&](int) { free.step(kStep, input); }, 10, 2000, 10));
  const Vector3d start(0, 0, 60e-6);
  input.mouth.position = start;
  CellMotion held = placedBeforeMouth(config, input, -500);
  add("time_held_and_moved", callTimes(
                                 [&](int i) {
                                   input.mouth.position.y() = 20e-6 * std::sin(0.01 * i);
                                   held.step(kStep, input);
                                 },
                                 1, 5000, 20));
  input.mouth.position = start;
  CellMotion pushed = placedBeforeMouth(config, input, -500);
  run(pushed, input, 50);
  const Vector3d touch = pushed.state().position + Vector3d(config.radius, 3e-6, 0);
  const auto pushing = [&](double depth, double rate) {
    return [&, depth, rate](int i) {
      input.needle = along(Vector3d::UnitX(), touch - Vector3d(depth * (1 - std::cos(rate * i)) / 2, 0, 0));
      pushed.step(kStep, input);
    };
  };
  add("time_held_with_needle", callTimes(pushing(5e-6, 0.005), 1, 5000, 20));
  add("time_needle_jumps_50_um", callTimes(pushing(50e-6, M_PI), 1, 1000, 20));
}

/// Pick-up from 2 um, lift, drop; heights are of the cell's lowest point.
void addCourse(Rows& rows) {
  const CellMotionConfig config;
  CellMotionInput input;
  input.mouth.position = {0, 0, config.radius};
  CellMotion motion = placedBeforeMouth(config, input, 0, 2e-6);
  for (int i = 0; i < 4000; ++i) {
    const double time = kStep * i;
    if (i == 200) input.pressure = -500;
    if (time > 0.5 && time < 1.5) input.mouth.position.z() += 80e-6 * kStep;
    if (time >= 2) input.pressure = 0;
    const CellMotionState& state = motion.step(kStep, input);
    if (i % 20 != 0) continue;
    rows.add("course_height", time, state.position.z() - config.radius, NAN, "m");
    rows.add("course_mouth", time, input.mouth.position.z() - config.radius, NAN, "m");
    rows.add("course_suction", time, state.suction, NAN, "N");
    rows.add("course_leak", time, state.leak, NAN, "m^3/s");
  }
}

std::string table() {
  Rows rows;
  addStokes(rows);
  addRest(rows);
  addHoldLimits(rows);
  for (const double beside : {10e-6, 15e-6, 20e-6, 25e-6}) addSlip(rows, beside);
  addRolling(rows);
  addEnergy(rows);
  addHardCases(rows);
  addOrder(rows);
  addTimes(rows);
  addCourse(rows);
  return rows.text();
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv, "cell_motion: a cell as a whole in its medium, against closed forms",
                                   microinjection::table);
}
