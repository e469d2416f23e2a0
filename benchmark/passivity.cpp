// Energy and limit cycles at the hand: impedance, stiffness, delay, loss, chatter, cells that are held, slide, are
// loose or are pierced by mechanics.

#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <random>
#include <string>

#include "benchmark/bench_main.h"
#include "benchmark/common/served_pierced_cell.h"
#include "benchmark/common/teleoperation_loop.h"
#include "benchmark/common/touched_cell.h"

namespace microinjection {
namespace {

using Controller = TeleoperationLoop::Controller;
using Result = TeleoperationLoop::Result;

constexpr Controller kControllers[] = {Controller::kOff, Controller::kObserver, Controller::kWave};
constexpr double kStillAmplitude = 5e-5;  // m, below which a hand is at rest
constexpr double kDecay = 0.95;     // an oscillation that keeps more than this from second to second is a limit cycle
constexpr int kWays = 400;          // of a needle alone
constexpr double kRounding = 1e-3;  // of what the needle has given, that it may get back: rounding of its steps

struct DrivenNeedle {
  double fastest, period;  // m/s, s
};
/// What an operator does; far beyond it, in steps as long as the dent; the same, finely sampled.
constexpr DrivenNeedle kDrivenNeedles[] = {{300e-6, 1e-3}, {5e-3, 1e-3}, {5e-3, 1e-4}};

std::string name(Controller controller) {
  if (controller == Controller::kOff) return "off";
  return controller == Controller::kObserver ? "one_port" : "wave";
}

bool isLimitCycle(const Result& result) {
  return result.late_amplitude > kStillAmplitude && result.late_over_early > kDecay;
}

bool isPassive(const TeleoperationLoop& loop, const Result& result) {
  return result.observed_energy_min >= -loop.bridge.passivity.reserve;
}

struct Summary {
  int cases = 0, active = 0, limit_cycles = 0;
  double lowest = 0, lowest_touched = 0, peak_force = 0;

  void add(const TeleoperationLoop& loop, const Result& result) {
    ++cases;
    active += isPassive(loop, result) ? 0 : 1;
    limit_cycles += isLimitCycle(result) ? 1 : 0;
    lowest = std::min(lowest, result.observed_energy_min);
    lowest_touched = std::min(lowest_touched, result.touched_energy_min);
    peak_force = std::max(peak_force, result.peak_force);
  }
};

class Table {
 public:
  Table(int draws, const std::string& blocks) : draws_(draws), blocks_(blocks) {}

  std::string make() {
    emit(
        "block,controller,seed,hand_mass_kg,hand_stiffness_N_per_m,hand_damping_N_s_per_m,stiffness_N_per_m,delay_ms,"
        "jitter_ms,loss,chatter,observed_energy_min_J,"
        "tolerance_J,"
        "passive,true_energy_min_J,channel_margin_min_J,limit_cycle,late_amplitude_um,late_over_early,contact_force_N,"
        "needle_force_N,"
        "peak_force_N,peak_force_rate_N_per_s,needle_overshoot_um,needle_drift_um,touched_energy_min_J\n");
    for (const Controller controller : kControllers) {
      if (!asked("grid")) break;
      for (const double damping : {0.0, 5.0, 15.0, 50.0}) {
        for (const double stiffness : {20.0, 60.0, 200.0, 600.0, 2000.0, 4000.0})
          conditions(controller, damping, stiffness);
      }
    }
    for (int i = 0; asked("drawn") && i < draws_; ++i) {
      for (const Controller controller : kControllers) {
        TeleoperationLoop loop = drawn(i);
        loop.controller = controller;
        add("drawn", loop);
      }
    }
    for (const TouchedCell cell : kTouchedCells) {
      if (!asked(name(cell))) continue;
      for (const Controller controller : kControllers) cells(cell, controller);
    }
    for (const PiercedCase& cell : kPiercedCases) {
      if (asked(cell.name)) pierced(cell);
    }
    for (const auto& [controller, sum] : summaries_) {
      std::fprintf(stderr,
                   "%s: %d cases, %d not passive, %d limit cycles, lowest energy %.2g J, of what is touched %.2g J, "
                   "largest force %.2f N\n",
                   controller.c_str(), sum.cases, sum.active, sum.limit_cycles, sum.lowest, sum.lowest_touched,
                   sum.peak_force);
    }
    return rows_;
  }

 private:
  bool asked(const std::string& block) const {
    return (',' + blocks_ + ',').find(',' + block + ',') != std::string::npos;
  }

  /// Between the grid's values, and with a network of its own.
  static TeleoperationLoop drawn(int number) {
    std::mt19937 random(1000 + number);
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    TeleoperationLoop loop;
    loop.hand.mass = between(0.1, 0.4);
    loop.hand.stiffness = between(150, 800);
    loop.hand.damping = number % 4 == 0 ? 0 : between(5, 50);
    loop.stiffness = 20 * std::pow(200, between(0, 1));
    loop.link.delay = between(0, 0.2);
    loop.link.jitter = between(0, 1) * std::max(5e-3, loop.link.delay);
    loop.link.loss = between(0, 0.2);
    loop.link.seed = 5000 + number;
    loop.chatter = between(0, 1) < 0.5;
    return loop;
  }

  void conditions(Controller controller, double damping, double stiffness) {
    TeleoperationLoop loop;
    loop.controller = controller;
    loop.hand.damping = damping;
    loop.stiffness = stiffness;
    for (const bool chatter : {false, true}) {
      loop.chatter = chatter;
      loop.link = {};
      add("grid", loop);
      for (const double delay : {0.0, 0.02, 0.05, 0.1, 0.2}) {
        loop.link.delay = delay;
        loop.link.jitter = delay > 0 ? delay / 2 : 2e-3;
        loop.link.loss = 0.2;
        add("grid", loop);
      }
    }
  }

  void cells(TouchedCell cell, Controller controller) {
    cells(name(cell), controller,
          [=](double stiffness) { return makeTouchedCell(cell, stiffness, TeleoperationLoop::kPressedForce); });
  }

  /// Under a hand, and under a needle alone, which no hand or bridge hides.
  void pierced(const PiercedCase& of) {
    const ServedPiercedCell cell(of);
    for (const Controller controller : kControllers) {
      cells(of.name, controller,
            [&](double stiffness) { return cell.makeTouched(stiffness, TeleoperationLoop::kPressedForce); });
    }
    for (const DrivenNeedle& needle : kDrivenNeedles) {
      const WaysOfNeedle ways = driveRandomWays(cell, kWays, 1, needle.fastest, needle.period);
      const bool passive = ways.least_energy >= -kRounding * ways.largest_given;
      std::fprintf(
          stderr,
          "%s: onset at %.2f um, %.3f uN; %d ways of a needle to %.3g um/s, sampled each %.3g ms, %d make a hole, "
          "%.3g J given at the most, %.2g J at the least: %s\n",
          of.name, 1e6 * cell.onset().depth, 1e6 * cell.onset().force, ways.ways, 1e6 * needle.fastest,
          1e3 * needle.period, ways.pierced, ways.largest_given, ways.least_energy,
          passive ? "passive" : "not passive");
    }
  }

  /// A cell under a hand, damped and not, with and without a network.
  void cells(const std::string& block, Controller controller,
             const std::function<TeleoperationLoop::Touched(double)>& makeTouched) {
    TeleoperationLoop loop;
    loop.controller = controller;
    for (const double damping : {0.0, 15.0}) {
      for (const double stiffness : {60.0, 600.0, 4000.0}) {
        for (const double delay : {0.0, 0.02, 0.1, 0.2}) {
          loop.hand.damping = damping;
          loop.stiffness = stiffness;
          loop.link.delay = delay;
          loop.link.jitter = delay / 2;
          loop.link.loss = delay > 0 ? 0.2 : 0;
          loop.makeTouched = [&] { return makeTouched(stiffness); };
          add(block, loop);
        }
      }
    }
  }

  void add(const std::string& block, const TeleoperationLoop& loop) {
    const Result r = loop.run();
    summaries_[block + ' ' + name(loop.controller)].add(loop, r);
    char text[400];
    std::snprintf(text, sizeof(text),
                  "%s,%s,%u,%.3g,%.4g,%.4g,%.5g,%.4g,%.4g,%.3g,%d,%.3e,%.1e,%s,%.3e,%.3e,%s,%.2f,%.3f,%.3f,%.3f,%.3f,%."
                  "0f,%.3f,%.3f,%.3e\n",
                  block.c_str(), name(loop.controller).c_str(), loop.link.seed, loop.hand.mass, loop.hand.stiffness,
                  loop.hand.damping, loop.stiffness, 1e3 * loop.link.delay, 1e3 * loop.link.jitter, loop.link.loss,
                  loop.chatter ? 1 : 0, r.observed_energy_min, loop.bridge.passivity.reserve,
                  isPassive(loop, r) ? "yes" : "no", r.true_energy_min, r.margin_min, isLimitCycle(r) ? "yes" : "no",
                  1e6 * r.late_amplitude, r.late_over_early, r.contact_force, r.needle_force, r.peak_force,
                  r.peak_force_rate, 1e6 * loop.bridge.motion.position_scale * r.overshoot, 1e6 * r.drift,
                  r.touched_energy_min);
    emit(text);
  }

  void emit(const std::string& text) {
    std::cout << text << std::flush;
    rows_ += text;
  }

  int draws_;
  std::string blocks_;
  std::string rows_;
  std::map<std::string, Summary> summaries_;
};

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  int draws = 150;
  std::string blocks = "grid,drawn,adhering,held,sliding,loose";
  for (const microinjection::PiercedCase& cell : microinjection::kPiercedCases) blocks += std::string(",") + cell.name;
  boost::program_options::options_description more;
  more.add_options()("draws", boost::program_options::value(&draws)->default_value(draws),
                     "cases between the grid's, each with a network of its own")(
      "blocks", boost::program_options::value(&blocks)->default_value(blocks), "of cases");
  return microinjection::benchMain(
      argc, argv, "passivity: energy and limit cycles of the hand's port, controllers off and on",
      [&] { return microinjection::Table(draws, blocks).make(); }, more);
}
