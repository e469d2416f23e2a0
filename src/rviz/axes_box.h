#pragma once

#include <cell_microinjection/CalibrateAxes.h>

#include <QWidget>
#include <memory>
#include <vector>

#include "operation/console/axes_tasks.h"
#include "rviz/background_call.h"
#include "rviz/lamp_row.h"
#include "rviz/node_diagnostics.h"
#include "rviz/offer_row.h"

namespace microinjection {

/// Buttons for the axes of the haptic device, each with its effect or the reason why it is greyed, and the residual of
/// the motions so far.
///
/// In: /diagnostics; service /haptic_bridge/calibrate_axes, called as BackgroundCall.
class AxesBox : public QWidget {
 public:
  explicit AxesBox(QWidget* parent = nullptr);
  ~AxesBox() override;
  /// Subscribes: other consoles have no use for the messages.
  void start(const std::shared_ptr<Bus>& bus);
  /// Shows the newest of the messages that were handled.
  void refresh();

 private:
  struct Answer {
    bool came = false;
    cell_microinjection::CalibrateAxes::Response response;
  };
  void press(AxesTask task);
  void take(const Answer& answer);
  AxesView view() const;

  std::shared_ptr<Bus> bus_;  ///< null: not started
  NodeDiagnostics diagnostics_{"haptic_bridge: loop"};
  AxesView axes_;
  BackgroundCall<Answer> call_;
  std::vector<OfferRow> rows_;
  LampRow* report_;
};

}  // namespace microinjection
