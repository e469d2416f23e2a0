#pragma once

#include <array>
#include <optional>
#include <string>

#include "operation/console/cell_lines.h"
#include "operation/console/console_commands.h"

namespace microinjection {

/// The console's buttons of the injector, from left to right.
enum class InjectorTask { kBalance, kReset };
constexpr std::array<InjectorTask, 2> kInjectorTasks = {InjectorTask::kBalance, InjectorTask::kReset};

/// What the console knows for them.
struct InjectorTasksView {
  std::optional<InjectorView> injector;  ///< its newest state; none: it is silent
  bool listens = false;                  ///< the node receives a balance pressure
  bool called = false;                   ///< its reset was called, and has not answered
  std::string refusal;                   ///< of the last reset; empty: it was not refused
};

/// What a button does now, or why it is greyed. A reset during a pulse would take the volume that ends it.
CommandOffer offer(InjectorTask task, const InjectorTasksView& view);
/// Below the buttons: why the last reset was refused, why a button is greyed, or what the reset does.
std::string injectorTasksText(const InjectorTasksView& view);

}  // namespace microinjection
