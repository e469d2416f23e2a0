#pragma once

#include <map>
#include <string>

#include "cell/identification/tongue_identification.h"
#include "vision/measurement/vision_config.h"

namespace microinjection {

/// Tongues of a held cell, measured in the images that a table names beside their suctions: its column `image` has
/// files, relative to the table, and readTongueRecord() takes the pressures by `columns`. A length is from the mouth
/// that the image shows to the tongue's end. Each image is searched as a whole, by both eyes, so that one does not
/// mislead the next. Where a tongue is not found or uncertain, the row is left out, and a note names image and reason.
/// @param vision  with the pixel size
/// @throws ConfigError for a table without images or pressures, and when no tongue is sure: with all reasons
TongueRecord measureTongues(const std::string& path, const std::map<std::string, std::string>& columns,
                            const VisionConfig& vision);

}  // namespace microinjection
