#pragma once

#include <array>
#include <string>

namespace microinjection {

/// What a console may show below its steps and its headline.
enum class ConsolePart {
  kCommands,
  kHand,
  kAxes,
  kDevices,
  kInjector,
  kAutomatic,
  kCell,
  kGuards,
  kScore,
  kSensor,
  kNeedle,
  kCalibration,
  kPlots
};
constexpr std::array<ConsolePart, 13> kConsoleParts = {
    ConsolePart::kCommands, ConsolePart::kHand,      ConsolePart::kAxes,   ConsolePart::kDevices,
    ConsolePart::kInjector, ConsolePart::kAutomatic, ConsolePart::kCell,   ConsolePart::kGuards,
    ConsolePart::kScore,    ConsolePart::kSensor,    ConsolePart::kNeedle, ConsolePart::kCalibration,
    ConsolePart::kPlots};
/// The word for a part in a task's file (config/console).
const char* toText(ConsolePart part);

/// The parts of a task.
struct ConsoleParts {
  std::array<bool, kConsoleParts.size()> shown{};
  std::string unknown;  ///< the words that are no part

  bool has(ConsolePart part) const { return shown[static_cast<std::size_t>(part)]; }
  /// From words with spaces between them. The commands are always there: STOP is one of them.
  static ConsoleParts read(const std::string& words);
};

/// The parts of a console that was added by hand.
constexpr char kUsualParts[] = "commands devices cell guards plots";

}  // namespace microinjection
