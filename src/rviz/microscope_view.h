#pragma once

#include <cell_microinjection/VisionState.h>

#include <QImage>
#include <QTimer>
#include <QWidget>
#include <functional>
#include <optional>

#include "operation/console/image_view.h"

namespace microinjection {

/// An image of the microscope with what vision found in it. The wheel magnifies, and moves the focus while Ctrl is
/// held; a drag moves the image, a double click shows all of it, a click proposes a place for the tip. At first it
/// shows the cell that vision has found.
class MicroscopeView : public QWidget {
 public:
  explicit MicroscopeView(QWidget* parent = nullptr);
  /// `specimen`: what was found in this image, if anything is known.
  void display(const QImage& image, const std::optional<cell_microinjection::VisionState>& specimen);
  /// Instead of an image: why there is none.
  void displayNone(const QString& reason);
  /// `clicked` is called with the pixel of a click into the image.
  void onClick(std::function<void(const Eigen::Vector2d& pixel)> clicked) { clicked_ = std::move(clicked); }
  /// `moved` is called with the notches of the wheel that ask for another focus, positive away from the user.
  void onFocus(std::function<void(int notches)> moved) { focus_moved_ = std::move(moved); }
  /// The proposed place, px.
  void setGoal(const std::optional<Eigen::Vector2d>& pixel);
  QSize sizeHint() const override { return {640, 340}; }
  QSize minimumSizeHint() const override { return {200, 120}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;

 private:
  void showSpecimen();

  ImageView view_;
  QImage image_;
  std::optional<cell_microinjection::VisionState> specimen_;
  QString reason_ = "no image yet";
  bool chosen_ = false;  ///< the part that is shown, by the operator
  std::optional<QPoint> pressed_, dragged_;
  Eigen::Vector2d pressed_pixel_ = Eigen::Vector2d::Zero();  ///< the view may move before the release
  QTimer click_;                                             ///< until a click is no double click
  std::optional<Eigen::Vector2d> goal_;
  std::function<void(const Eigen::Vector2d&)> clicked_;
  std::function<void(int)> focus_moved_;
  double turned_ = 0;  ///< notches of the wheel that are not a whole one yet
};

}  // namespace microinjection
