#pragma once

#include <rviz/panel.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "operation/console/console_parts.h"
#include "rviz/session_link.h"

class QTimer;

namespace microinjection {

class CalibrationBox;
class CommandsWidget;
class ElidedLabel;
class ForcePlot;
class GuardRow;
class HandBox;
class InjectionBox;
class InjectorBar;
class LampRow;
class NeedleBar;
class ScoreBox;
class SensorBox;
class AxesBox;
class StepsWidget;
class ViewRow;

/// The operator's console: a panel of rviz with the state of the injection, the commands with their
/// reasons, lamps of the devices, guards, and the force against time and depth.
///
/// It only shows and sends commands: no node waits for it. All its work runs in the timer of rviz's
/// GUI thread, which is why a command waits for a frame that rviz draws.
///
/// Its configuration: Parts, the words of ConsoleParts. A part that is not shown has no subscribers of
/// its own.
class ConsolePanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit ConsolePanel(QWidget* parent = nullptr);
  ~ConsolePanel() override;
  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;
  QSize sizeHint() const override;

 private:
  QWidget* makeCommands();
  QWidget* makeDevices();
  QWidget* makeCell();
  QWidget* makeGuards();
  QWidget* makePlots();
  QWidget*& box(ConsolePart part) { return boxes_[static_cast<std::size_t>(part)]; }
  SessionView newest();
  void showParts(const std::string& words);
  std::optional<Eigen::Isometry3d> needle(double largest_age) const;
  std::optional<SessionLink::Pose> pipette() const;
  void tick();
  void showState();
  void plot();

  std::unique_ptr<SessionLink> link_;
  QTimer* timer_;
  int ticks_ = 0;
  bool grown_ = false;     ///< the history, since it was plotted
  unsigned contacts_ = 0;  ///< of the past lines that are plotted
  std::string words_ = kUsualParts;
  ConsoleParts parts_;
  std::array<QWidget*, kConsoleParts.size()> boxes_{};

  StepsWidget* steps_;
  LampRow* headline_;
  CommandsWidget* commands_ = nullptr;
  HandBox* hand_ = nullptr;
  CalibrationBox* calibration_ = nullptr;
  ScoreBox* score_ = nullptr;
  ViewRow* view_ = nullptr;
  SensorBox* sensor_ = nullptr;
  AxesBox* axes_ = nullptr;
  NeedleBar* needle_ = nullptr;
  InjectionBox* injection_ = nullptr;
  InjectorBar* injector_bar_ = nullptr;
  std::array<LampRow*, kDevices.size()> devices_{};
  ElidedLabel *served_ = nullptr, *puncture_ = nullptr;
  LampRow *estimate_ = nullptr, *injector_ = nullptr;
  GuardRow *force_guard_ = nullptr, *depth_guard_ = nullptr;
  ForcePlot *over_time_ = nullptr, *over_depth_ = nullptr;
};

}  // namespace microinjection
