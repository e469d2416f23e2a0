// A family's new member: time to serve it, to change it while it is served, and the steps meanwhile.

#include <time.h>

#include <Eigen/Core>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/call_times.h"
#include "cell/choice/make_cell_model.h"

namespace microinjection {
namespace {

constexpr double kPeriod = 1e-3, kSpan = 5;  ///< s
constexpr int kSpans = 4;                    ///< with changes, and as many without
constexpr int kStarts = 9;
constexpr auto kBetween = std::chrono::milliseconds(50);
constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_injection.yaml";

double wall() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double threadTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

ChosenCellModel serve() {
  CellModelConfig config;
  config.families = MICROINJECTION_SOURCE_DIR "/config/families";
  ChosenCellModel served = makeCellModel(loadScene(kScene), "surrogate", config, kScene);
  if (!served.change) throw std::runtime_error("no family serves " + std::string(kScene));
  return served;
}

/// Times of the steps of a needle that goes in and out of the cell.
struct Steps {
  std::vector<double> cpu, intervals;  ///< us

  void run(CellModel& cell, double& time) {
    double due = wall(), last = due;
    for (int i = 0; i < static_cast<int>(kSpan / kPeriod); ++i) {
      due += kPeriod;
      timespec until{static_cast<time_t>(due), static_cast<long>(1e9 * (due - std::floor(due)))};
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
      const double now = wall();
      intervals.push_back(1e6 * (now - last));
      last = now;
      const double height = 24e-6 + 6e-6 * std::cos(5 * time);  // m, of the tip
      time += kPeriod;
      const double start = threadTime();
      cell.step({1e-6, 0, height}, Eigen::Vector3d::UnitZ(), time);
      cpu.push_back(1e6 * (threadTime() - start));
    }
  }
};

std::string row(const char* quantity, const std::vector<double>& values, const char* unit) {
  char line[200];
  std::snprintf(line, sizeof(line), "%s,%.4g,%.4g,%.4g,%s\n", quantity, quantile(values, 0.5), quantile(values, 0.99),
                quantile(values, 1), unit);
  std::fputs(line, stdout);
  return line;
}

std::string table() {
  std::string rows = "quantity,median,99 of 100,largest,unit\n";
  std::fputs(rows.c_str(), stdout);
  std::vector<double> starts;
  for (int i = 0; i < kStarts; ++i) {
    const double start = wall();
    serve();
    starts.push_back(1e3 * (wall() - start));
  }
  rows += row("scene file to served member", starts, "ms");
  const ChosenCellModel served = serve();
  std::vector<double> changes;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1, 1);
  Steps quiet, changing;
  double time = 0;
  for (int span = 0; span < kSpans; ++span) {
    quiet.run(*served.cell, time);
    std::atomic<bool> stop{false};
    std::thread changer([&] {
      while (!stop) {
        const double start = wall();
        served.change->change({{"young_modulus", 17.9e3 * std::pow(3, share(random))},
                               {"diameter", 56e-6 * (1 + 0.1 * share(random))},
                               {"poisson_ratio", 0.475 + 0.02 * share(random)}});
        changes.push_back(1e3 * (wall() - start));
        std::this_thread::sleep_for(kBetween);
      }
    });
    changing.run(*served.cell, time);
    stop = true;
    changer.join();
  }
  rows += row("change while it is served", changes, "ms");
  rows += row("step", quiet.cpu, "us of CPU");
  rows += row("step, a change every 50 ms", changing.cpu, "us of CPU");
  rows += row("interval of 1 ms steps", quiet.intervals, "us");
  rows += row("interval of 1 ms steps, a change every 50 ms", changing.intervals, "us");
  return rows;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(
      argc, argv, "bench_member_change: a family's new member, and changes while it is served.", microinjection::table);
}
