#pragma once

#include <string>
#include <vector>

#include "benchmark/common/marked_image.h"

namespace microinjection {

/// Real images and what is known of them. A place that was read in one plane of a focus stack holds for the others,
/// too, with 0.3 px more of tolerance for each plane; up to five planes away it must be found.
class Micrographs {
 public:
  /// `folder`: with GROUND_TRUTH.csv, and a folder for each source. Throws ConfigError.
  explicit Micrographs(const std::string& folder);

  const std::vector<std::string>& names() const { return names_; }  ///< of the images in their sources
  /// Leaves those whose name has one of the parts in it.
  void keepOnly(const std::vector<std::string>& parts);
  /// Throws ConfigError when it cannot be read.
  MarkedImage load(const std::string& name) const;

 private:
  struct Reading {
    std::string file;
    ImageMark mark;
  };
  std::vector<ImageMark> marksOf(const std::string& name) const;

  std::string folder_;
  std::vector<std::string> names_;
  std::vector<Reading> readings_;
};

}  // namespace microinjection
