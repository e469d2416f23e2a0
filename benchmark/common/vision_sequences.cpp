#include <cmath>

#include "benchmark/common/vision_real.h"

namespace microinjection {
namespace {

constexpr int kHeldFrames = 4;
constexpr double kSequenceLimit = 3;  // px

/// A row of a thing that a frame of the sequence shows.
VisionRow sequenceRow(const std::string& set, const std::string& image, const std::string& what,
                      const Finding& finding) {
  VisionRow row{set, image, what};
  row.found = finding.hasValues();
  row.sure = finding.isFound();
  row.verdict = nameOf(finding.verdict);
  row.reason = finding.reason;
  return row;
}

void heldRows(const Micrographs& micrographs, const std::string& set, const std::vector<int>& stages,
              const std::shared_ptr<SecondEye>& eye, const TakeRow& take) {
  const auto imageOf = [&](int stage) {
    return micrographs.load("holypipette/stack" + std::to_string(stage) + ".8.jpg");
  };
  SpecimenTracker tracker(trackerConfig(imageOf(stages.front()), RealSetup::kTold), eye);
  for (const int stage : stages) {
    const MarkedImage image = imageOf(stage);
    const Frame frame(image.image);
    for (int i = 1; i <= kHeldFrames; ++i) {
      const SpecimenView& view = tracker.next(frame);
      const std::string name = image.name + "#" + std::to_string(i);
      VisionRow tip = sequenceRow(set, name, "tip", view.injection.finding);
      const cv::Point2d off = view.injection.end - image.marks.front().place;
      if (tip.found) tip.error = std::hypot(off.x, off.y);
      tip.right = tip.sure && tip.error <= kSequenceLimit;
      tip.wrong = tip.sure && !*tip.right;
      take(tip);
      for (const auto& [what, finding] : {std::pair<const char*, Finding>{"mouth_absent", view.holding.finding},
                                          std::pair<const char*, Finding>{"cell_absent", view.cell.finding}}) {
        VisionRow row = sequenceRow(set, name, what, finding);
        row.wrong = row.sure;
        take(row);
      }
    }
  }
}

}  // namespace

void sequenceRows(const Micrographs& micrographs, const std::shared_ptr<SecondEye>& eye, const TakeRow& take) {
  heldRows(micrographs, "real_retreat", {6, 3, 0}, eye, take);
  heldRows(micrographs, "real_advance", {0, 3, 6}, eye, take);
}

}  // namespace microinjection
