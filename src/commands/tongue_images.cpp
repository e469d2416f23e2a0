#include "commands/tongue_images.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <vector>

#include "base/errors.h"
#include "base/lower_case.h"
#include "base/text_table.h"
#include "vision/camera/image_file.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {
namespace {

constexpr char kMeasured[] = "tongue measured in the image";  ///< title of the column that is added

/// The files that the rows name; empty where one names none.
std::vector<std::string> imagesOf(const TextTable& table) {
  const auto found = std::find_if(table.columns.begin(), table.columns.end(), [](const TextTable::Column& column) {
    return lowerCase(column.title) == "image" && !column.texts.empty();
  });
  if (found == table.columns.end())
    throw ConfigError(table.path + ": has no column 'image' with names of files: must have one with --pixel-size");
  return found->texts;
}

BoreBorder tongueIn(const std::string& file, const SpecimenTrackerConfig& config,
                    const std::shared_ptr<SecondEye>& eye) {
  const LoadedImage loaded = loadImage(file);
  BoreBorder tongue;
  tongue.finding = Finding::notFound(loaded.refusal);
  return loaded.refusal.empty() ? SpecimenTracker(config, eye).next(Frame(loaded.image)).tongue : tongue;
}

}  // namespace

TongueRecord measureTongues(const std::string& path, const std::map<std::string, std::string>& columns,
                            const VisionConfig& vision) {
  if (columns.count("tongue") > 0) throw ConfigError("--column tongue: must be left out with --pixel-size");
  TextTable table = readTextTable(path, 1);
  const std::vector<std::string> images = imagesOf(table);
  const std::shared_ptr<SecondEye> eye = vision.secondEye();
  TextTable::Column measured;
  measured.title = kMeasured;
  std::vector<std::string> refused;
  for (const std::string& image : images) {
    const BoreBorder tongue = tongueIn(std::filesystem::path(path).parent_path() / image, vision.tracker, eye);
    const bool sure = tongue.finding.isFound();
    measured.values.push_back(sure ? vision.pixel_size * tongue.length : std::numeric_limits<double>::quiet_NaN());
    if (sure) ++measured.numbers;
    if (!sure)
      refused.push_back("image '" + image + "': tongue " + nameOf(tongue.finding.verdict) + ": " +
                        tongue.finding.reason);
  }
  if (measured.numbers == 0) throw ConfigError(path + ": no image shows a tongue surely:\n" + join(refused, "\n"));
  table.notes.insert(table.notes.end(), refused.begin(), refused.end());
  table.columns.push_back(measured);
  std::map<std::string, std::string> named = columns;
  named["tongue"] = std::string(kMeasured) + ":m";
  return readTongueRecord(table, named);
}

}  // namespace microinjection
