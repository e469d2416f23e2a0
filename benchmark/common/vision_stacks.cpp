#include <cmath>
#include <map>

#include "benchmark/common/tip_sharpness.h"
#include "benchmark/common/vision_real.h"
#include "vision/calibration/statistics.h"
#include "vision/calibration/tip_focus.h"
#include "vision/measurement/sharpness.h"

namespace microinjection {
namespace {

constexpr int kStartPlane = 8;
constexpr int kStackPlanes = 17;                           // 1 um apart
constexpr double kBestPlane = 8.5, kFocusLimit = 0.5;      // planes
constexpr double kStageScale = 5.38, kScaleLimit = 0.005;  // px for 1 um; of the scale
constexpr double kCoreOfRadius = 0.3;                      // see TipInImage

std::string planeName(int stage, int plane) {
  return "holypipette/stack" + std::to_string(stage) + "." + std::to_string(plane) + ".jpg";
}

/// The planes of a stack, and where its tip is: the stage stands still, so there is one window for all planes.
struct TipStack {
  std::vector<Frame> frames;
  std::vector<double> x, y;  ///< px, of the tips that are sure
  PipetteDetection start;    ///< of the plane nearest to the best one, as a search of the focus starts with
};

TipStack readStack(const Micrographs& micrographs, int stage) {
  TipStack stack;
  for (int plane = 0; plane < kStackPlanes; ++plane) {
    const MarkedImage image = micrographs.load(planeName(stage, plane));
    stack.frames.emplace_back(image.image);
    const PipetteDetector detector(trackerConfig(image, RealSetup::kTold).injection);
    const PipetteDetection found = detector.detect(stack.frames.back());
    if (plane == kStartPlane) stack.start = found;
    if (!found.finding.isFound()) continue;
    stack.x.push_back(found.end.x);
    stack.y.push_back(found.end.y);
  }
  return stack;
}

Finding findingOf(const FocusReport& report) {
  if (report.verdict == FocusVerdict::kFocus) return Finding::found();
  return report.verdict == FocusVerdict::kUnsure ? Finding::uncertain(report.text) : Finding::notFound(report.text);
}

template <typename Sharpness>
VisionRow bestPlaneRow(int stage, const std::string& what, const TipStack& stack, const Sharpness& sharpness) {
  std::vector<FocusSample> samples;
  for (std::size_t plane = 0; plane < stack.frames.size(); ++plane)
    samples.push_back({1e-6 * static_cast<double>(plane), sharpness(stack.frames[plane])});
  const FocusReport best = findFocus(samples, {});
  const Finding finding = findingOf(best);
  VisionRow row{"real_stacks", "holypipette/stack" + std::to_string(stage), what};
  row.found = finding.hasValues();
  row.sure = finding.isFound();
  row.verdict = nameOf(finding.verdict);
  if (row.found) row.error = std::abs(1e6 * best.height - kBestPlane);
  row.right = row.sure && row.error <= kFocusLimit;
  row.wrong = row.sure && !*row.right;
  return row;
}

VisionRow stageScaleRow(const std::map<int, cv::Point2d>& tips) {
  const double scale = cv::norm(tips.at(0) - tips.at(6)) / 60;
  VisionRow row{"real_stacks", "holypipette", "stage_scale"};
  row.found = row.sure = true;
  row.verdict = nameOf(Verdict::kFound);
  row.error = std::abs(scale - kStageScale);
  row.relative = row.error / kStageScale;
  row.right = row.relative <= kScaleLimit;
  row.wrong = !*row.right;
  return row;
}

}  // namespace

void focusStackRows(const Micrographs& micrographs, const TakeRow& take) {
  std::map<int, cv::Point2d> tips;
  for (const int stage : {0, 3, 6}) {
    const TipStack stack = readStack(micrographs, stage);
    if (stack.x.empty()) continue;
    const cv::Point2d tip(medianOf(stack.x), medianOf(stack.y));
    const double direction = micrographs.load(planeName(stage, kStartPlane)).needle;
    tips[stage] = tip;
    take(bestPlaneRow(stage, "best_plane_walls", stack,
                      [&](const Frame& frame) { return tipSharpness(frame, tip, direction); }));
    const PipetteDetection& seen = stack.start;
    const int advised = static_cast<int>(std::lround(kCoreOfRadius * seen.half_width));
    for (const auto& [what, core] : {std::pair<std::string, int>{"best_plane_core", TipInImage{}.core},
                                     std::pair<std::string, int>{"best_plane_core_fit", std::max(1, advised)}}) {
      take(bestPlaneRow(stage, what, stack, [&, half = core](const Frame& frame) {
        return coreSharpness(frame, {seen.end, seen.direction, half});
      }));
    }
  }
  if (tips.count(0) + tips.count(6) == 2) take(stageScaleRow(tips));
}

}  // namespace microinjection
