#include "rviz/microscope_panel.h"

#include <rviz/properties/property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>
#include <pluginlib/class_list_macros.hpp>

#include <QDockWidget>
#include <QMainWindow>
#include <QTimer>
#include <QVBoxLayout>

#include "nodes/bus/ros_bus.h"
#include "rviz/microscope_widget.h"

namespace microinjection {
namespace {

constexpr float kScene = 0.85F;  // of the window's height, that the scene has without an image

template <typename Widget>
Widget* parentOf(QWidget* widget) {
  for (QWidget* parent = widget->parentWidget(); parent != nullptr; parent = parent->parentWidget()) {
    if (auto* found = qobject_cast<Widget*>(parent)) return found;
  }
  return nullptr;
}

}  // namespace

MicroscopePanel::MicroscopePanel(QWidget* parent)
    : rviz::Panel(parent), microscope_(new MicroscopeWidget([this] { appear(); }, this)), timer_(new QTimer(this)) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(microscope_);
}

MicroscopePanel::~MicroscopePanel() {
  delete microscope_;  // before its bus
}

void MicroscopePanel::onInitialize() {
  bus_ = std::make_shared<RosBus>(RosBus::Master::kIgnored);
  microscope_->start(*bus_);
  connect(timer_, &QTimer::timeout, this, [this] { microscope_->tick(); });
  timer_->start(MicroscopeWidget::kPeriod);
}

/// rviz docks panels on the left. The places of a window that the user has saved come after this.
void MicroscopePanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  config.mapGetFloat("Share", &share_);
  auto* dock = parentOf<QDockWidget>(this);
  auto* window = parentOf<QMainWindow>(this);
  if (dock == nullptr || window == nullptr) return;
  window->setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  window->addDockWidget(Qt::BottomDockWidgetArea, dock);
  dock->hide();
}

void MicroscopePanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Share", share_);
}

void MicroscopePanel::appear() {
  auto* dock = parentOf<QDockWidget>(this);
  auto* window = parentOf<QMainWindow>(this);
  if (dock == nullptr || window == nullptr) return;
  dock->show();
  window->resizeDocks({dock}, {static_cast<int>(share_ * static_cast<float>(window->height()))}, Qt::Vertical);
  // rviz scales the scene with its height: its letters would become too small to be read.
  rviz::ViewController* view = vis_manager_ != nullptr ? vis_manager_->getViewManager()->getCurrent() : nullptr;
  if (view == nullptr) return;
  rviz::Property* distance = view->subProp("Distance");
  distance->setValue(distance->getValue().toFloat() * kScene * (1 - share_));
}

}  // namespace microinjection

PLUGINLIB_EXPORT_CLASS(microinjection::MicroscopePanel, rviz::Panel)
