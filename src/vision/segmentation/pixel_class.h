#pragma once

#include <array>
#include <cstddef>

namespace microinjection {

/// What a pixel of a micrograph shows. The order is that of the network's output.
enum class PixelClass : unsigned char {
  kBackground,
  kBoreMedium,  ///< medium in the bore of a holding pipette
  kZona,
  kPerivitellineSpace,
  kOoplasm,  ///< also the inside of a cell or vesicle without zona
  kPolarBody,
  kHoldingPipette,    ///< glass of the wall
  kInjectionPipette,  ///< wall and bore
  kBubble,
  kDebris,
  kBurntIn  ///< text, scale bars, frames, crosshairs
};

constexpr std::size_t kPixelClasses = 11;

/// Names as in the weights' description, in the order of PixelClass.
constexpr std::array<const char*, kPixelClasses> kPixelClassNames = {
    "background",        "bore medium", "zona",   "perivitelline space", "ooplasm", "polar body", "holding pipette",
    "injection pipette", "bubble",      "debris", "burnt-in mark"};

constexpr const char* nameOf(PixelClass pixel_class) { return kPixelClassNames[static_cast<std::size_t>(pixel_class)]; }

}  // namespace microinjection
