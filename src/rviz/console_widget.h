#pragma once

#include <Eigen/Geometry>
#include <QWidget>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "operation/console/console_parts.h"
#include "operation/console/device_lamps.h"
#include "rviz/session_link.h"

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

/// The operator's console: the state of the injection, the commands with their reasons, lamps of the devices, guards,
/// and the force against time and depth.
///
/// It only shows and sends commands: no node waits for it. A part that is not shown has no subscribers of its own.
class ConsoleWidget : public QWidget {
 public:
  static constexpr int kPeriod = 16;  ///< ms, of tick(): the plot at 60 Hz

  /// The pose of the needle's tip in `world`; empty: it is older than `largest_age` (s), or not known.
  using NeedlePose = std::function<std::optional<Eigen::Isometry3d>(double largest_age)>;

  explicit ConsoleWidget(NeedlePose needle, QWidget* parent = nullptr);
  ~ConsoleWidget() override;
  /// Connects to the session. The bus must outlive this widget.
  void start(const std::shared_ptr<Bus>& bus);
  /// The words of ConsoleParts.
  void showParts(const std::string& words);
  const std::string& parts() const { return words_; }
  /// Handles the messages that came, and shows the newest.
  void tick();
  QSize sizeHint() const override { return {640, 700}; }

 private:
  QWidget* makeCommands();
  QWidget* makeDevices();
  QWidget* makeCell();
  QWidget* makeGuards();
  QWidget* makePlots();
  QWidget*& box(ConsolePart part) { return boxes_[static_cast<std::size_t>(part)]; }
  SessionView newest();
  std::optional<SessionLink::Pose> pipette() const;
  void showState();
  void plot();

  NeedlePose needle_pose_;
  std::shared_ptr<Bus> bus_;
  std::unique_ptr<SessionLink> link_;
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
