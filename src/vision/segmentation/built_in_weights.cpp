#include "vision/segmentation/built_in_weights.h"

// The assembler copies the files' bytes: as C++ they would be ten times as long and compile as slowly.
#define MICROINJECTION_INCLUDE_FILE(name, file)                                                               \
  __asm__(".section .rodata\n.balign 16\n.global " #name "\n" #name ":\n.incbin \"" file "\"\n.global " #name \
          "_end\n" #name "_end:\n.byte 0\n.previous\n");                                                      \
  extern "C" const char name[], name##_end[];

MICROINJECTION_INCLUDE_FILE(microinjection_weights, MICROINJECTION_WEIGHTS)
MICROINJECTION_INCLUDE_FILE(microinjection_weights_description, MICROINJECTION_WEIGHTS_DESCRIPTION)

namespace microinjection {

std::string_view builtInWeights() {
  return {microinjection_weights, static_cast<std::size_t>(microinjection_weights_end - microinjection_weights)};
}

std::string_view builtInDescription() {
  return {microinjection_weights_description,
          static_cast<std::size_t>(microinjection_weights_description_end - microinjection_weights_description)};
}

}  // namespace microinjection
