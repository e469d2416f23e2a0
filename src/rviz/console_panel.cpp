#include "rviz/console_panel.h"

#include <ros/console.h>
#include <rviz/visualization_manager.h>
#include <pluginlib/class_list_macros.hpp>

#include <QTimer>
#include <QVBoxLayout>
#include <clocale>
#include <string>

#include "nodes/bus/ros_bus.h"
#include "rviz/console_widget.h"
#include "rviz/tip_pose.h"

namespace microinjection {

// rviz listens to tf already: another subscriber at 1 kHz would only cost.
ConsolePanel::ConsolePanel(QWidget* parent)
    : rviz::Panel(parent),
      console_(new ConsoleWidget(
          [this](double largest_age) { return tipPose(*vis_manager_->getTF2BufferPtr(), bus_->now(), largest_age); },
          this)),
      timer_(new QTimer(this)) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(console_);
}

ConsolePanel::~ConsolePanel() {
  delete console_;  // before its bus
}

QSize ConsolePanel::sizeHint() const { return console_->sizeHint(); }

void ConsolePanel::onInitialize() {
  // Qt takes the user's locale. A session starts rviz with LC_ALL=C; a person may have started this one.
  if (std::string(std::localeconv()->decimal_point) != ".")
    ROS_ERROR(
        "this rviz reads numbers with another decimal sign than a point and misplaces what it shows: start it with "
        "LC_ALL=C");
  bus_ = std::make_shared<RosBus>(RosBus::Master::kIgnored);
  console_->start(bus_);
  connect(timer_, &QTimer::timeout, this, [this] { console_->tick(); });
  timer_->start(ConsoleWidget::kPeriod);
}

void ConsolePanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString words;
  if (config.mapGetString("Parts", &words)) console_->showParts(words.toStdString());
}

void ConsolePanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Parts", QString::fromStdString(console_->parts()));
}

}  // namespace microinjection

PLUGINLIB_EXPORT_CLASS(microinjection::ConsolePanel, rviz::Panel)
