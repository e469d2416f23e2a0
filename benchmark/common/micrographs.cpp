#include "benchmark/common/micrographs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "base/errors.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

constexpr double kTolerancePerPlane = 0.3;  // px
constexpr int kReadablePlanes = 5;          // to either side of the one that was read

bool isOf(const std::string& name, const std::string& source) { return name.rfind(source, 0) == 0; }

/// An image of a focus stack: what all planes share, and the plane.
struct StackPlane {
  std::string stack;
  int plane = 0;
};

std::optional<StackPlane> stackPlane(const std::string& name) {
  const std::size_t end = name.rfind('.');
  std::size_t begin = end;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(name[begin - 1])) != 0) --begin;
  if (begin == end || !(isOf(name, "holypipette/stack") || isOf(name, "autopatcher_ig/"))) return std::nullopt;
  return StackPlane{name.substr(0, begin), std::stoi(name.substr(begin, end - begin))};
}

std::string thingOf(const std::string& object) {
  if (object == "pipette_tip") return "tip";
  if (object == "pipette_mouth") return "mouth";
  return object == "vesicle_inner_edge" ? "vesicle" : object;
}

/// By sight: what LICENSES.md says of the sources. Four wells of autooocyte are empty.
void describe(MarkedImage& image) {
  const std::string& name = image.name;
  static const std::set<std::string> empty = {"1.jpg", "2.jpg", "7.jpg", "8.jpg"};
  image.has_holding = isOf(name, "vampy/");
  image.has_needle = isOf(name, "holypipette/") || isOf(name, "autopatcher_ig/");
  image.has_cell = !image.has_needle;
  if (isOf(name, "autooocyte/")) image.has_cell = empty.count(name.substr(name.rfind('_') + 1)) == 0;
  image.contrast_mode = image.has_holding               ? ContrastMode::kPhase
                        : isOf(name, "autopatcher_ig/") ? ContrastMode::kDic
                                                        : ContrastMode::kBrightField;
  image.needle = isOf(name, "autopatcher_ig/") ? 160 * M_PI / 180 : 0;
  image.holding = image.needle + M_PI;
  if (image.has_holding) image.holding = name == "vampy/test.png" ? M_PI : 0;
  if (image.has_holding) image.needle = image.holding + M_PI;
}

}  // namespace

Micrographs::Micrographs(const std::string& folder) : folder_(folder) {
  std::ifstream file(folder + "/GROUND_TRUTH.csv");
  if (!file) throw ConfigError(folder + "/GROUND_TRUTH.csv: cannot be read: it has the readings of the micrographs");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line.rfind("file,", 0) == 0) continue;
    std::istringstream text(line);
    std::vector<std::string> cells;
    for (std::string part; std::getline(text, part, ',');) cells.push_back(part);
    if (cells.size() < 8) throw ConfigError(folder + "/GROUND_TRUTH.csv: fewer than 8 columns: " + line);
    const auto number = [&](int column) { return std::atof(cells[static_cast<std::size_t>(column)].c_str()); };
    ImageMark mark{thingOf(cells[1]), {number(2), number(3)}, std::sqrt(number(4) * number(5)), number(7)};
    readings_.push_back({cells[0], mark});
  }
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".png" || extension == ".jpg") names_.push_back(fs::relative(entry.path(), folder));
  }
  std::sort(names_.begin(), names_.end());
}

void Micrographs::keepOnly(const std::vector<std::string>& parts) {
  const auto is_left_out = [&](const std::string& name) {
    return std::none_of(parts.begin(), parts.end(),
                        [&](const std::string& part) { return name.find(part) != std::string::npos; });
  };
  names_.erase(std::remove_if(names_.begin(), names_.end(), is_left_out), names_.end());
}

std::vector<ImageMark> Micrographs::marksOf(const std::string& name) const {
  std::vector<ImageMark> marks;
  const std::optional<StackPlane> here = stackPlane(name);
  for (const Reading& reading : readings_) {
    if (reading.file == name) marks.push_back(reading.mark);
    const std::optional<StackPlane> there = stackPlane(reading.file);
    if (reading.file == name || !here || !there || here->stack != there->stack) continue;
    const int planes = std::abs(here->plane - there->plane);
    ImageMark mark = reading.mark;
    mark.tolerance += kTolerancePerPlane * planes;
    mark.readable = planes <= kReadablePlanes;
    marks.push_back(mark);
  }
  return marks;
}

MarkedImage Micrographs::load(const std::string& name) const {
  MarkedImage image;
  image.name = name;
  image.image = cv::imread(folder_ + "/" + name, cv::IMREAD_UNCHANGED);
  if (image.image.empty()) throw ConfigError(folder_ + "/" + name + ": cannot be read as an image");
  if (image.image.channels() == 4) cv::cvtColor(image.image, image.image, cv::COLOR_BGRA2BGR);
  // The lower half of this source's images is its own segmentation, drawn.
  if (isOf(name, "usama_oocyte/")) image.image = image.image.rowRange(0, image.image.rows / 2).clone();
  image.marks = marksOf(name);
  describe(image);
  return image;
}

}  // namespace microinjection
