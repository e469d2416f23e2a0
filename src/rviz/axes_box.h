#pragma once

#include <cell_microinjection/CalibrateAxes.h>

#include <QWidget>
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
  void start() { diagnostics_.start(); }
  /// Reads the messages that came, and shows the newest.
  void refresh();

 private:
  struct Answer {
    bool came = false;
    cell_microinjection::CalibrateAxes::Response response;
  };
  void press(AxesTask task);
  void take(const Answer& answer);
  AxesView view() const;

  NodeDiagnostics diagnostics_{"haptic_bridge: loop"};
  AxesView axes_;
  BackgroundCall<Answer> call_;
  std::vector<OfferRow> rows_;
  LampRow* report_;
};

}  // namespace microinjection
