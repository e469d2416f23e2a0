#include "rviz/console_widget.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>
#include <limits>
#include <utility>

#include "operation/console/headline.h"
#include "rviz/axes_box.h"
#include "rviz/calibration_box.h"
#include "rviz/colours.h"
#include "rviz/commands_widget.h"
#include "rviz/force_plot.h"
#include "rviz/guard_row.h"
#include "rviz/hand_box.h"
#include "rviz/injection_box.h"
#include "rviz/injector_bar.h"
#include "rviz/lamp_row.h"
#include "rviz/needle_bar.h"
#include "rviz/score_box.h"
#include "rviz/sensor_box.h"
#include "rviz/steps_widget.h"
#include "rviz/view_row.h"

namespace microinjection {
namespace {

constexpr int kStatePeriod = 6;  // ticks: the texts at 10 Hz, which nobody reads faster

constexpr double kOldPose = 0.5;    // s, of the needle that is moved by steps
constexpr double kDeepest = 50e-6;  // m, of the plot where the guard is not known

QVBoxLayout* column(QWidget* parent) {
  auto* layout = new QVBoxLayout(parent);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  return layout;
}

QLabel* heading(const QString& text, QWidget* parent) {
  auto* label = new QLabel("<b>" + text + "</b>", parent);
  label->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  return label;
}

QString coloured(const QString& text, QRgb colour) {
  return "<font color='" + QColor(colour).name() + "'>" + text + "</font>";
}

}  // namespace

ConsoleWidget::ConsoleWidget(NeedlePose needle, QWidget* parent)
    : QWidget(parent),
      needle_pose_(std::move(needle)),
      steps_(new StepsWidget(this)),
      headline_(new LampRow("", 2, this)) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 4, 6, 4);
  layout->setSpacing(6);
  layout->addWidget(steps_);
  layout->addWidget(headline_);
  box(ConsolePart::kCommands) = makeCommands();
  box(ConsolePart::kHand) = hand_ = new HandBox(this);
  box(ConsolePart::kAxes) = axes_ = new AxesBox(this);
  box(ConsolePart::kDevices) = makeDevices();
  const auto newest_injector = [this] {
    newest();
    return link_ ? link_->injector() : std::nullopt;
  };
  box(ConsolePart::kInjector) = injector_bar_ = new InjectorBar(newest_injector, this);
  box(ConsolePart::kAutomatic) = injection_ = new InjectionBox([this] { return newest(); }, this);
  box(ConsolePart::kCell) = makeCell();
  box(ConsolePart::kGuards) = makeGuards();
  box(ConsolePart::kScore) = score_ = new ScoreBox(this);
  box(ConsolePart::kSensor) = sensor_ = new SensorBox(this);
  box(ConsolePart::kCalibration) = calibration_ = new CalibrationBox([this] { return newest(); }, this);
  box(ConsolePart::kNeedle) = needle_ =
      new NeedleBar([this] { return newest(); }, [this] { return needle_pose_(kOldPose); }, this);
  box(ConsolePart::kPlots) = makePlots();
  auto* middle = new QHBoxLayout;
  middle->setSpacing(12);
  middle->addWidget(box(ConsolePart::kCommands), 1);
  auto* right = new QVBoxLayout;
  right->setSpacing(8);
  for (const ConsolePart part :
       {ConsolePart::kHand, ConsolePart::kAxes, ConsolePart::kDevices, ConsolePart::kInjector, ConsolePart::kAutomatic,
        ConsolePart::kCell, ConsolePart::kGuards, ConsolePart::kSensor}) {
    right->addWidget(box(part));
  }
  right->addStretch(1);
  middle->addLayout(right, 1);
  layout->addLayout(middle);
  layout->addWidget(box(ConsolePart::kScore));
  layout->addWidget(box(ConsolePart::kNeedle));
  layout->addWidget(box(ConsolePart::kCalibration));
  layout->addWidget(box(ConsolePart::kPlots), 1);
  showParts(words_);
}

ConsoleWidget::~ConsoleWidget() = default;

SessionView ConsoleWidget::newest() {
  if (link_) grown_ = link_->poll() || grown_;
  return link_ ? link_->session() : SessionView();
}

QWidget* ConsoleWidget::makeCommands() {
  const auto send = [this](ConsoleCommand button, const std::string& command) {
    if (!link_) return;
    if (button == ConsoleCommand::kStop) {
      link_->stop(command);
      needle_->stop();
    } else {
      link_->send(command);
    }
  };
  commands_ = new CommandsWidget([this] { return newest(); }, send, this);
  return commands_;
}

QWidget* ConsoleWidget::makeDevices() {
  auto* box = new QWidget(this);
  QVBoxLayout* layout = column(box);
  layout->addWidget(heading("Devices", box));
  for (const Device device : kDevices) {
    auto* row = new LampRow(toText(device), 1, box);
    devices_[static_cast<std::size_t>(device)] = row;
    layout->addWidget(row);
  }
  layout->addWidget(injector_ = new LampRow("Injector", 1, box));
  return box;
}

QWidget* ConsoleWidget::makeCell() {
  auto* box = new QWidget(this);
  QVBoxLayout* layout = column(box);
  layout->addWidget(heading("Cell", box));
  layout->addWidget(view_ = new ViewRow(box));
  layout->addWidget(served_ = new ElidedLabel(2, box));
  layout->addWidget(estimate_ = new LampRow("Estimate", 2, box));
  layout->addWidget(puncture_ = new ElidedLabel(1, box));
  return box;
}

QWidget* ConsoleWidget::makeGuards() {
  auto* box = new QWidget(this);
  QVBoxLayout* layout = column(box);
  layout->addWidget(heading("Guards", box));
  layout->addWidget(force_guard_ = new GuardRow(box));
  layout->addWidget(depth_guard_ = new GuardRow(box));
  return box;
}

QWidget* ConsoleWidget::makePlots() {
  auto* box = new QWidget(this);
  auto* layout = new QGridLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  const QString time = "Force, uN, over time, s: " + coloured("predicted", kPredictedColour) + ", " +
                       coloured("measured", kMeasuredColour);
  const QString depth = "Over um deep: " + coloured("guard", kGuardColour) + ", " +
                        coloured("puncture", kPunctureColour) + ", " + coloured("before", kPastTextColour);
  int half = 0;
  for (const QString& text : {time, depth}) {
    auto* title = new QLabel(text, box);
    title->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    layout->addWidget(title, 0, half);
    layout->setColumnStretch(half++, 1);
  }
  layout->addWidget(over_time_ = new ForcePlot(box), 1, 0);
  layout->addWidget(over_depth_ = new ForcePlot(box), 1, 1);
  over_time_->display({}, {}, -ForceHistory::kWindow, 0);
  over_depth_->display({}, {}, 0, 1e6 * kDeepest);
  layout->setRowStretch(1, 1);
  box->setMinimumHeight(150);
  return box;
}

void ConsoleWidget::start(const std::shared_ptr<Bus>& bus) {
  bus_ = bus;
  link_ = std::make_unique<SessionLink>(*bus, [this] { return pipette(); });
  showParts(words_);
}

void ConsoleWidget::showParts(const std::string& words) {
  words_ = words;
  parts_ = ConsoleParts::read(words);
  for (const ConsolePart part : kConsoleParts) box(part)->setVisible(parts_.has(part));
  if (!link_) return;
  if (parts_.has(ConsolePart::kCell)) view_->start(*bus_);
  if (parts_.has(ConsolePart::kHand)) hand_->start(*bus_);
  if (parts_.has(ConsolePart::kAxes)) axes_->start(bus_);
  if (parts_.has(ConsolePart::kCalibration)) calibration_->start(bus_);
  if (parts_.has(ConsolePart::kSensor)) sensor_->start(bus_);
  if (parts_.has(ConsolePart::kNeedle)) needle_->start(*bus_);
  if (parts_.has(ConsolePart::kInjector)) injector_bar_->start(bus_);
  if (parts_.has(ConsolePart::kAutomatic)) injection_->start(*bus_);
  if (parts_.has(ConsolePart::kScore)) score_->start(*bus_, *link_);
}

std::optional<SessionLink::Pose> ConsoleWidget::pipette() const {
  const auto pose = needle_pose_(std::numeric_limits<double>::infinity());
  if (!pose) return std::nullopt;
  return SessionLink::Pose{pose->translation(), pose->linear().col(2)};
}

void ConsoleWidget::tick() {
  grown_ = link_->poll() || grown_;
  if (ticks_++ % kStatePeriod == 0) showState();
  if (std::exchange(grown_, false) && isVisible() && parts_.has(ConsolePart::kPlots)) plot();
}

void ConsoleWidget::showState() {
  const SessionView session = link_->session();
  steps_->display(session.injection);
  headline_->display(parts_.unknown.empty() ? headline(session)
                                            : Lamp{Light::kRed, "the console has no part: " + parts_.unknown});
  commands_->display(session);
  for (const Device device : kDevices) devices_[static_cast<std::size_t>(device)]->display(link_->lamp(device));
  const auto estimate = link_->estimate();
  estimate_->display(estimateLamp(estimate));
  puncture_->setText(QString::fromStdString(punctureText(estimate)));
  injector_->display(injectorLamp(link_->injector(), link_->injectorHeard()));
  const std::string served = link_->servedCell();
  served_->setText(served.empty() ? "the served cell is not known" : QString::fromStdString(served));
  force_guard_->display(forceMargin(session));
  depth_guard_->display(depthMargin(session));
  hand_->refresh();
  calibration_->refresh(session);
  score_->refresh();
  sensor_->refresh();
  axes_->refresh();
  needle_->refresh(session);
  injection_->refresh(session);
  injector_bar_->refresh(link_->injector());

  ForcePlot::Limits limits;
  if (session.settings.force_limit) limits.force = *session.settings.force_limit * 1e6;
  over_time_->showLimits(limits);
  if (session.settings.depth_limit) limits.across = *session.settings.depth_limit * 1e6;
  if (estimate && estimate->puncture_depth > 0) {
    limits.puncture = estimate->puncture_depth * 1e6;
    limits.puncture_low = estimate->puncture_low * 1e6;
    limits.puncture_high = estimate->puncture_high * 1e6;
  }
  over_depth_->showLimits(limits);
}

void ConsoleWidget::plot() {
  const ForceHistory& history = link_->history();
  over_time_->display(history.predictedOverTime(), history.measuredOverTime(), -ForceHistory::kWindow, 0);
  if (contacts_ != history.contacts()) over_depth_->showPast(history.past());
  contacts_ = history.contacts();
  const double guard = link_->session().settings.depth_limit.value_or(kDeepest);
  over_depth_->display(history.predictedOverDepth(), history.measuredOverDepth(), 0, 1.1e6 * guard);
}

}  // namespace microinjection
