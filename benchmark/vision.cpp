// Cells, pipettes, dimples and focus: errors on rendered images with exact truth, and on real micrographs.

#include <algorithm>
#include <boost/program_options.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/contact_sheet.h"
#include "benchmark/common/image_transform.h"
#include "benchmark/common/printed_table.h"
#include "benchmark/common/vision_cases.h"
#include "benchmark/common/vision_real.h"
#include "benchmark/common/vision_summary.h"
#include "vision/measurement/vision_config.h"

namespace microinjection {
namespace {

constexpr const char* kFolderVariable = "MICROINJECTION_MICROGRAPHS";
constexpr char kStacks[] = "real_stacks", kSequences[] = "real_sequences";  // parts of the set real

struct VisionOptions {
  int images = 40;
  std::uint64_t seed = 100001;
  std::string only, contact_sheet, eyes = "both";
  std::shared_ptr<SecondEye> eye;
  std::vector<std::string> transforms, micrographs;
  bool pipettes_only = false, told = false;
};

VisionOptions vision_options;

std::string rowOf(const VisionRow& row) {
  const auto flag = [](const std::optional<bool>& value) { return value ? std::string(*value ? "1" : "0") : ""; };
  return row.set + ',' + row.image + ',' + row.what + ',' + row.group + ',' + numberText(row.error, "%.4f") + ',' +
         numberText(row.relative, "%.6f") + ',' + numberText(row.deviation, "%.4f") + ',' + flag(row.covered) + ',' +
         flag(row.right) + ',' + (row.wrong ? "1" : "0") + ',' + row.verdict + ',' +
         numberText(1e3 * row.time, "%.3f") + ",\"" + row.reason + "\"\n";
}

/// The transforms that --transform names, or all.
std::vector<ImageTransform> chosenTransforms() {
  const std::vector<ImageTransform> all = imageTransforms();
  if (vision_options.transforms.empty()) return all;
  std::vector<ImageTransform> chosen;
  for (const std::string& name : vision_options.transforms) {
    const auto place =
        std::find_if(all.begin(), all.end(), [&](const ImageTransform& each) { return each.name == name; });
    if (place == all.end()) {
      std::string known;
      for (const ImageTransform& each : all) known += (known.empty() ? "" : ", ") + each.name;
      throw ConfigError("--transform " + name + ": no such transform; there are " + known);
    }
    chosen.push_back(*place);
  }
  return chosen;
}

bool isRealSet(const std::string& name) { return name == "real" || name == kStacks || name == kSequences; }

void measureReal(const Micrographs& micrographs, const TakeRow& take) {
  const std::string& only = vision_options.only;
  const bool all = only != kStacks && only != kSequences;
  if (all)
    realRows(micrographs, chosenTransforms(), vision_options.told ? RealSetup::kTold : RealSetup::kDefault,
             vision_options.eye, take);
  if (all && !(vision_options.transforms.empty() && vision_options.micrographs.empty())) return;
  if (only != kSequences) focusStackRows(micrographs, take);
  if (only != kStacks) sequenceRows(micrographs, vision_options.eye, take);
}

void writeContactSheet(const std::vector<SheetImage>& images) {
  std::vector<unsigned char> file;
  cv::imencode(std::filesystem::path(vision_options.contact_sheet).extension(),
               contactSheet(images, vision_options.eye), file);
  writeFileAtomically(vision_options.contact_sheet, std::string(file.begin(), file.end()));
}

std::string table() {
  if (vision_options.eyes != "both" && vision_options.eyes != "geometry")
    throw ConfigError("--eyes " + vision_options.eyes + ": must be both or geometry");
  VisionConfig config = VisionConfig::standard();
  config.eyes = vision_options.eyes;
  vision_options.eye = config.secondEye();
  PrintedTable rows;
  VisionSummary summary;
  rows.add("set,image,what,group,error_px,error_relative,deviation_px,covered,right,wrong,verdict,time_ms,reason\n");
  const auto take = [&](const VisionRow& row) {
    rows.add(rowOf(row));
    summary.add(row);
  };
  const std::string& only = vision_options.only;
  const bool sheet = !vision_options.contact_sheet.empty();
  const std::string extension = std::filesystem::path(vision_options.contact_sheet).extension();
  if (sheet && extension != ".png" && extension != ".jpg")
    throw ConfigError("--contact-sheet " + vision_options.contact_sheet + ": must end in .png or .jpg");
  for (const VisionCondition& condition : visionConditions()) {
    if (!only.empty() && condition.name != only) continue;
    renderedRows(condition, vision_options.seed, vision_options.images, vision_options.pipettes_only,
                 vision_options.eye, take);
  }
  const char* folder = std::getenv(kFolderVariable);
  const bool real = folder != nullptr && (only.empty() || isRealSet(only));
  if (sheet && !real) writeContactSheet(renderedSheet(vision_options.seed));
  if (real) {
    Micrographs micrographs(folder);
    if (!vision_options.micrographs.empty()) micrographs.keepOnly(vision_options.micrographs);
    if (sheet) writeContactSheet(realSheet(micrographs, vision_options.eye != nullptr));
    measureReal(micrographs, take);
  }
  summary.print();
  return rows.text();
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  microinjection::VisionOptions& options = microinjection::vision_options;
  po::options_description more;
  const auto add = [&](const char* name, const po::value_semantic* value, const char* description) {
    more.add_options()(name, value, description);
  };
  add("images", po::value(&options.images)->default_value(options.images), "rendered images of each condition");
  add("only", po::value(&options.only),
      "one set: the name of a condition as in the table, real, real_stacks or real_sequences");
  add("seed", po::value(&options.seed)->default_value(options.seed),
      "of the first image; constants are chosen with seeds below 100000");
  add("pipettes", po::bool_switch(&options.pipettes_only), "rendered images: measures the pipettes only");
  add("transform", po::value(&options.transforms)->multitoken(),
      "real images: under these transforms only, such as identity");
  add("micrograph", po::value(&options.micrographs)->multitoken(),
      "real images: those only whose file has one of these parts in its name, such as vampy/ or stack6.8");
  add("eyes", po::value(&options.eyes)->default_value(options.eyes),
      "both: a network tells where things are; geometry: without it");
  add("told", po::bool_switch(&options.told),
      "real images: look and directions of the pipettes are those of the image, not the default ones");
  add("contact-sheet", po::value(&options.contact_sheet),
      "PNG or JPEG to write: the real images, or where their folder is not named two rendered ones of each condition, "
      "with what is found in them");
  return microinjection::benchMain(argc, argv,
                                   "bench_vision: errors of the vision on rendered images, and on real ones where "
                                   "MICROINJECTION_MICROGRAPHS names their folder.",
                                   microinjection::table, more);
}
