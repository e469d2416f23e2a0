#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "cell/family/family_cell.h"

namespace microinjection {

inline constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families";
inline constexpr char kInjectedCell[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_injection.yaml";

/// The scene's surrogate cell, a member of a shipped family.
inline std::shared_ptr<const SurrogateData> memberOf(const Scene& scene) {
  std::string reason;
  const auto cell = findFamilyCell(kFamilies, scene, reason);
  EXPECT_TRUE(cell) << reason;
  return cell->data;
}

}  // namespace microinjection
