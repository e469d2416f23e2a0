#pragma once

#include <QWidget>
#include <memory>

#include "rviz/lamp_row.h"
#include "rviz/offer_row.h"
#include "rviz/pixel_goal_link.h"

namespace microinjection {

/// Below the microscope's image: Go, Cancel, and how far the needle is on its way to the pixel that a
/// click has proposed.
class PixelGoalBar : public QWidget {
 public:
  explicit PixelGoalBar(QWidget* parent = nullptr);
  /// Connects to the session.
  void start(Bus& bus);
  /// Reads the messages that came, and shows the newest.
  void refresh();
  void propose(const Eigen::Vector2d& pixel);
  void discard();
  std::optional<Eigen::Vector2d> pixel() const;

 private:
  void cancel();

  std::unique_ptr<OfferRow> go_, cancel_;
  LampRow* report_;
  std::unique_ptr<PixelGoalLink> link_;
};

}  // namespace microinjection
