#pragma once

#include <cell_microinjection/InjectAction.h>

#include <QWidget>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "operation/console/automatic_injection.h"
#include "rviz/lamp_row.h"
#include "rviz/offer_row.h"
#include "rviz/task_runner.h"

namespace microinjection {

template <>
std::pair<bool, std::string> outcomeOf(const cell_microinjection::InjectResult& result);

/// The configured injection in mode automatic: Start, Cancel, progress and outcome. Hidden in every other mode.
///
/// Action: /controller/inject
class InjectionBox : public QWidget {
 public:
  /// `newest`: gives the session at the moment of a press.
  explicit InjectionBox(std::function<SessionView()> newest, QWidget* parent = nullptr);
  ~InjectionBox() override;
  /// Connects to the action: other consoles have no use for its messages.
  void start(Bus& bus);
  /// Shows the newest of the messages that were handled.
  void refresh(const SessionView& session);

 private:
  using Runner = ActionRunner<cell_microinjection::InjectAction>;
  void checkServer();
  void press();
  void end(bool success, const std::string& message);

  std::function<SessionView()> newest_;
  std::unique_ptr<OfferRow> start_;
  OfferButton* cancel_;
  LampRow* report_;
  Lamp shown_{Light::kGrey, "nothing was started here"};
  bool running_ = false;
  Bus* bus_ = nullptr;  ///< null: not started
  std::unique_ptr<Runner> runner_;
};

}  // namespace microinjection
