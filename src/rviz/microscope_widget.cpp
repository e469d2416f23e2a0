#include "rviz/microscope_widget.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <QGridLayout>
#include <QImage>
#include <QString>
#include <QVBoxLayout>
#include <cstdint>
#include <utility>

#include "rviz/focus_bar.h"
#include "rviz/lamp_row.h"
#include "rviz/microscope_view.h"
#include "rviz/pixel_goal_bar.h"
#include "rviz/specimen_painter.h"

namespace microinjection {
namespace {

constexpr std::uint32_t kLargestSide = 16384;  // px

/// The picture of a message: grey, colour or Bayer, of 8 or 16 bits. A picture of 16 bits is
/// stretched from its darkest to its brightest value. Null with the reason in `defect` for a message
/// that cannot be read.
QImage toPicture(const sensor_msgs::Image& message, QString& defect) {
  namespace encodings = sensor_msgs::image_encodings;
  // cv_bridge compares the length in 32 bits, and would read beyond a short one.
  const bool sized = message.width > 0 && message.height > 0 && message.width <= kLargestSide &&
                     message.height <= kLargestSide &&
                     std::uint64_t{message.height} * message.step == message.data.size();
  if (!sized) {
    defect = "its size or length is wrong";
    return {};
  }
  try {
    const auto source = cv_bridge::toCvShare(message, boost::shared_ptr<void const>());
    cv_bridge::CvtColorForDisplayOptions options;
    options.do_dynamic_scaling = encodings::bitDepth(message.encoding) > 8;
    const bool grey = message.encoding == encodings::MONO8;
    const cv::Mat pixels =
        grey ? source->image : cv_bridge::cvtColorForDisplay(source, encodings::RGB8, options)->image;
    const auto format = grey ? QImage::Format_Grayscale8 : QImage::Format_RGB888;
    return QImage(pixels.data, pixels.cols, pixels.rows, static_cast<int>(pixels.step), format).copy();
  } catch (const std::exception& error) {  // cv_bridge's and OpenCV's
    defect = error.what();
    return {};
  }
}

}  // namespace

MicroscopeWidget::MicroscopeWidget(std::function<void()> appear, QWidget* parent)
    : QWidget(parent),
      appear_(std::move(appear)),
      view_(new MicroscopeView(this)),
      goal_(new PixelGoalBar(this)),
      focus_(new FocusBar(this)) {
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

MicroscopeWidget::~MicroscopeWidget() = default;

void MicroscopeWidget::start(Bus& bus) {
  link_ = std::make_unique<MicroscopeLink>(bus);
  goal_->start(bus);
  focus_->start(bus);
}

void MicroscopeWidget::showFindings(const std::optional<cell_microinjection::VisionState>& specimen) {
  if (!specimen) {
    for (LampRow* row : findings_) row->display({});
    findings_[0]->display({Light::kGrey, "vision is silent"});
    return;
  }
  const auto lines = findingLines(*specimen);
  for (std::size_t i = 0; i < findings_.size(); ++i) findings_[i]->display(lines[i]);
}

/// What is not seen anymore is no place to go to.
void MicroscopeWidget::displayNone(const QString& reason) {
  view_->displayNone(reason);
  goal_->discard();
}

void MicroscopeWidget::tick() {
  if (!appeared_ && link_->hasSource()) {
    appeared_ = true;
    appear_();
  }
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
