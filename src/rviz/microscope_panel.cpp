#include "rviz/microscope_panel.h"

#include <rviz/properties/property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>
#include <pluginlib/class_list_macros.hpp>

#include <QDockWidget>
#include <QGridLayout>
#include <QMainWindow>
#include <QTimer>
#include <QVBoxLayout>

#include "rviz/focus_bar.h"
#include "rviz/image_conversion.h"
#include "rviz/lamp_row.h"
#include "rviz/microscope_view.h"
#include "rviz/pixel_goal_bar.h"
#include "rviz/specimen_painter.h"

namespace microinjection {
namespace {

constexpr int kImagePeriod = 66;  // ms: 15 Hz, as the scene
constexpr float kScene = 0.85F;   // of the window's height, that the scene has without an image

template <typename Widget>
Widget* parentOf(QWidget* widget) {
  for (QWidget* parent = widget->parentWidget(); parent != nullptr; parent = parent->parentWidget()) {
    if (auto* found = qobject_cast<Widget*>(parent)) return found;
  }
  return nullptr;
}

}  // namespace

MicroscopePanel::MicroscopePanel(QWidget* parent)
    : rviz::Panel(parent),
      view_(new MicroscopeView(this)),
      goal_(new PixelGoalBar(this)),
      focus_(new FocusBar(this)),
      timer_(new QTimer(this)) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  layout->addWidget(view_, 1);
  // Below the image and not on it: letters would cover what they speak of.
  auto* lines = new QGridLayout;
  lines->setContentsMargins(6, 0, 6, 2);
  lines->setHorizontalSpacing(12);
  lines->setVerticalSpacing(0);
  for (std::size_t i = 0; i < findings_.size(); ++i) {
    findings_[i] = new LampRow("", 1, this);
    lines->addWidget(findings_[i], static_cast<int>(i) / 2, static_cast<int>(i) % 2);
  }
  layout->addLayout(lines);
  layout->addWidget(focus_);
  layout->addWidget(goal_);
  view_->onClick([this](const Eigen::Vector2d& pixel) {
    goal_->propose(pixel);
    view_->setGoal(goal_->pixel());
  });
  view_->onFocus([this](int steps) { focus_->move(steps); });
  showFindings(std::nullopt);
}

MicroscopePanel::~MicroscopePanel() = default;

void MicroscopePanel::onInitialize() {
  link_ = std::make_unique<MicroscopeLink>();
  goal_->start();
  focus_->start();
  connect(timer_, &QTimer::timeout, this, [this] { tick(); });
  timer_->start(kImagePeriod);
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
  appeared_ = true;
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

void MicroscopePanel::showFindings(const std::optional<cell_microinjection::VisionState>& specimen) {
  if (!specimen) {
    for (LampRow* row : findings_) row->display({});
    findings_[0]->display({Light::kGrey, "vision is silent"});
    return;
  }
  const auto lines = findingLines(*specimen);
  for (std::size_t i = 0; i < findings_.size(); ++i) findings_[i]->display(lines[i]);
}

/// What is not seen anymore is no place to go to.
void MicroscopePanel::displayNone(const QString& reason) {
  view_->displayNone(reason);
  goal_->discard();
}

void MicroscopePanel::tick() {
  if (!appeared_ && link_->hasSource()) appear();
  if (appeared_) link_->listen(isVisible());
  goal_->refresh();
  focus_->refresh();
  view_->setGoal(goal_->pixel());
  const bool grown = link_->poll();
  if (!isVisible()) return;
  const auto image = link_->image();
  if (!image) {
    displayNone("no image: see the lamp of the camera");
    shown_.reset();
    showFindings(std::nullopt);
    return;
  }
  if (!grown && image == shown_) return;
  // A pixel of another image is another place.
  if (shown_ && (shown_->width != image->width || shown_->height != image->height)) goal_->discard();
  shown_ = image;
  const auto specimen = link_->specimen();
  showFindings(specimen);
  QString defect;
  const QImage picture = toPicture(*image, defect);
  if (picture.isNull()) {
    displayNone("an image cannot be read: " + defect);
  } else {
    view_->display(picture, specimen);
  }
}

}  // namespace microinjection

PLUGINLIB_EXPORT_CLASS(microinjection::MicroscopePanel, rviz::Panel)
