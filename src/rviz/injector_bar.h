#pragma once

#include <sensor_msgs/FluidPressure.h>

#include <QWidget>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "operation/console/injector_tasks.h"
#include "rviz/background_call.h"
#include "rviz/elided_label.h"
#include "rviz/number_field.h"
#include "rviz/offer_button.h"

namespace microinjection {

/// The injector's pressure between pulses, and a button that clears its fault and its volume, with what it does or why
/// they are greyed. It appears with the first state of an injector, whose lamp has what it refuses.
///
/// Out: injector/set_balance (FluidPressure, Pa, gauge); service /injector/reset, called as BackgroundCall.
class InjectorBar : public QWidget {
 public:
  /// `newest`: the injector's state at the moment of a press; none: it is silent.
  explicit InjectorBar(std::function<std::optional<InjectorView>()> newest, QWidget* parent = nullptr);
  ~InjectorBar() override;
  /// Connects to the session: other consoles do not send the command.
  void start(const std::shared_ptr<Bus>& bus);
  void refresh(const std::optional<InjectorView>& injector);

 private:
  InjectorTasksView view(const std::optional<InjectorView>& injector) const;
  void appear(const InjectorView& injector);
  void press(InjectorTask task);

  std::function<std::optional<InjectorView>()> newest_;
  NumberField* pressure_;  ///< Pa
  std::array<OfferButton*, kInjectorTasks.size()> buttons_{};
  ElidedLabel* text_;
  std::shared_ptr<Bus> bus_;  ///< null: not started
  Publisher<sensor_msgs::FluidPressure> commands_;
  std::string refusal_;
  BackgroundCall<std::string> call_;  ///< the reason for a refusal
};

}  // namespace microinjection
