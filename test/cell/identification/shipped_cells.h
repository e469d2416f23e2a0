#pragma once

namespace microinjection {

inline constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families";
inline constexpr char kZona[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_zona.yaml";

}  // namespace microinjection
