#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// What the decoder does not tell of a page of a TIFF file.
struct TiffPage {
  std::size_t directory = 0;   ///< number in the file, from 0
  bool min_is_white = false;   ///< 0 is white
  unsigned bits = 1;           ///< of a sample
  unsigned sample_format = 1;  ///< 1 unsigned, 2 signed, 3 floating point
  std::size_t described = 0;   ///< images that its description by ImageJ counts; 0: it has none
};

/// The pages of a TIFF or BigTIFF file, without thumbnails, smaller copies and masks. None: it is no TIFF file. Empty:
/// it is damaged.
std::optional<std::vector<TiffPage>> tiffPages(const std::string& path);

}  // namespace microinjection
