#pragma once

#include <ros/ros.h>

#include <QWidget>
#include <optional>
#include <string>
#include <utility>

#include "operation/console/cell_lines.h"
#include "rviz/background_call.h"
#include "rviz/offer_button.h"

class QDoubleSpinBox;

namespace microinjection {

/// The injector's pressure between pulses, and a button that clears its fault and its volume. It appears with an
/// injector, whose lamp has what it refuses.
///
/// Out: injector/set_balance (FluidPressure, Pa, gauge); service /injector/reset, called as BackgroundCall.
/// At first the field has the node's parameter `balance`.
class InjectorBar : public QWidget {
 public:
  explicit InjectorBar(QWidget* parent = nullptr);
  ~InjectorBar() override;
  /// Connects to the session: other consoles do not send the command.
  void start();
  /// `injector`: its newest state; none: it is silent.
  void refresh(const std::optional<InjectorView>& injector);

 private:
  void setBalance();
  void reset();

  QDoubleSpinBox* pressure_;  ///< Pa
  OfferButton *set_, *reset_;
  bool there_ = false;
  std::optional<ros::NodeHandle> node_;
  ros::Publisher commands_;
  BackgroundCall<std::string> call_;
};

}  // namespace microinjection
