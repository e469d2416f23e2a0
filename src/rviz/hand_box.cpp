#include "rviz/hand_box.h"

#include <QLabel>
#include <QVBoxLayout>

#include "rviz/elided_label.h"
#include "rviz/lamp_row.h"
#include "rviz/link_box.h"
#include "rviz/session_parameters.h"

namespace microinjection {
namespace {

constexpr double kBridgeSilence = 3;  // s, of haptic_bridge, whose state comes with each change and each second

bool firstButton(const sensor_msgs::Joy& message) { return !message.buttons.empty() && message.buttons[0] != 0; }

}  // namespace

HandBox::HandBox(QWidget* parent)
    : QWidget(parent),
      follows_(new LampRow("Needle", 2, this)),
      clutch_(new LampRow("Clutch", 1, this)),
      present_(new LampRow("Switch", 1, this)),
      position_(new ElidedLabel(1, this)),
      force_(new ElidedLabel(1, this)),
      link_(new LinkBox(this)) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(new QLabel("<b>Hand</b>", this));
  for (QWidget* row : {static_cast<QWidget*>(follows_), static_cast<QWidget*>(clutch_), static_cast<QWidget*>(present_),
                       static_cast<QWidget*>(position_), static_cast<QWidget*>(force_), static_cast<QWidget*>(link_)}) {
    layout->addWidget(row);
  }
}

void HandBox::start() {
  if (node_) return;
  node_.emplace();
  node_->setCallbackQueue(&queue_);
  link_->start();
  loop_ = node_->subscribe<cell_microinjection::LoopState>(
      "haptic/loop_state", 1,
      boost::function<void(const cell_microinjection::LoopState::ConstPtr&)>([this](const auto& message) {
        const double now = ros::SteadyTime::now().toSec();
        if (!heard_at_ || now - *heard_at_ > kBridgeSilence) readSettings();
        heard_at_ = now;
        hand_.has_bridge = true;
        hand_.hold_reason = message->follows ? "" : message->hold_reason;
      }));
  clutches_ = node_->subscribe<sensor_msgs::Joy>(
      "haptic/clutch", 1, boost::function<void(const sensor_msgs::Joy::ConstPtr&)>([this](const auto& message) {
        hand_.clutch = firstButton(*message);
      }));
  presences_ =
      node_->subscribe<sensor_msgs::Joy>("haptic/operator_present", 1,
                                         boost::function<void(const sensor_msgs::Joy::ConstPtr&)>(
                                             [this](const auto& message) { hand_.present = firstButton(*message); }));
}

/// The parameters are set before the bridge starts. To read them waits for the master, which is why
/// it is done only when a bridge appears.
void HandBox::readSettings() {
  HandSettings& settings = hand_.settings;
  settings = {};
  SessionParameters parameters("/haptic_bridge");
  settings.mode = parameters.text("mode");
  settings.force_source = parameters.text("force_source");
  settings.position_scale = parameters.number("position_scale");
  settings.rate_gain = parameters.number("rate_mode/gain");
  settings.force_gain = parameters.number("force_gain");
  settings.error = parameters.error();
}

void HandBox::refresh() {
  if (!node_) return;
  queue_.callAvailable(ros::WallDuration(0));
  HandView shown = hand_;
  if (!heard_at_ || ros::SteadyTime::now().toSec() - *heard_at_ > kBridgeSilence) shown.hold_reason.reset();
  follows_->display(followsLamp(shown));
  clutch_->display(clutchLamp(shown));
  present_->display(presentLamp(shown));
  position_->setText(QString::fromStdString(positionScaleText(shown.settings)));
  force_->setText(QString::fromStdString(forceScaleText(shown.settings)));
  link_->refresh();
}

}  // namespace microinjection
