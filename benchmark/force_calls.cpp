// The time of a force of a family's cell, asked from C++ for one tip after another: what ./dev bench python compares
// with.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "benchmark/bench_main.h"
#include "cell/family/family_cell.h"
#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {
namespace {

constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_injection.yaml";
constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families";
constexpr int kTips = 20000, kRuns = 31;
constexpr double kDeepest = 10e-6;  // m

std::string table() {
  const Scene scene = loadScene(kScene);
  std::string reason;
  const auto member = findFamilyCell(kFamilies, scene, reason);
  if (!member) throw std::runtime_error(reason);
  SurrogateContact contact(scene, member->data);
  const double touch = ContactFrame::at(scene, Eigen::Vector2d::Zero())->origin.z();
  std::vector<double> times;
  double sum = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kTips; ++i) {
      contact.reset();
      sum += contact.step({0, 0, touch - kDeepest * i / (kTips - 1)}).force.z();
    }
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
    times.push_back(took.count() / kTips);
  }
  std::sort(times.begin(), times.end());
  char row[160];
  std::snprintf(row, sizeof row, "median_ns,lowest_ns,highest_ns,mean_force_N\n%.1f,%.1f,%.1f,%.4g\n",
                times[times.size() / 2], times.front(), times.back(), sum / kTips / kRuns);
  std::fputs(row, stdout);
  return row;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv, "force_calls: time of a force of a family's cell, from C++",
                                   microinjection::table);
}
