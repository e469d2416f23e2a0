#pragma once

#include <rviz/panel.h>

#include <memory>

#include "rviz/session_link.h"

class QTimer;

namespace microinjection {

class CommandsWidget;
class ElidedLabel;
class ForcePlot;
class GuardRow;
class LampRow;
class StepsWidget;

/// The operator's console: a panel of rviz with the state of the injection, the commands with their
/// reasons, lamps of the devices, guards, and the force against time and depth.
///
/// It only shows and sends commands: no node waits for it. All its work runs in the timer of rviz's
/// GUI thread, which is why a command waits for a frame that rviz draws.
class ConsolePanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit ConsolePanel(QWidget* parent = nullptr);
  ~ConsolePanel() override;
  void onInitialize() override;
  QSize sizeHint() const override;

 private:
  QWidget* makeLeft();
  QWidget* makeRight();
  QWidget* makePlots();
  std::optional<Eigen::Vector3d> pipetteAxis() const;
  void tick();
  void showState();
  void plot();

  std::unique_ptr<SessionLink> link_;
  QTimer* timer_;
  int ticks_ = 0;
  bool grown_ = false;     ///< the history, since it was plotted
  unsigned contacts_ = 0;  ///< of the past lines that are plotted

  StepsWidget* steps_;
  LampRow* headline_;
  CommandsWidget* commands_ = nullptr;
  std::array<LampRow*, kDevices.size()> devices_{};
  ElidedLabel *served_ = nullptr, *puncture_ = nullptr;
  LampRow *estimate_ = nullptr, *injector_ = nullptr;
  GuardRow *force_guard_ = nullptr, *depth_guard_ = nullptr;
  ForcePlot *over_time_ = nullptr, *over_depth_ = nullptr;
};

}  // namespace microinjection
