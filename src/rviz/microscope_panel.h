#pragma once

#include <rviz/panel.h>

#include <array>
#include <memory>
#include <optional>

#include "rviz/microscope_link.h"

class QTimer;

namespace microinjection {

class FocusBar;
class LampRow;
class MicroscopeView;
class PixelGoalBar;

/// The microscope's image in a panel of rviz, below the scene. A click proposes a place for the tip,
/// which the needle is led to after Go. The panel appears with the first node
/// that publishes images: a session without a camera has room for the scene.
///
/// Its configuration: Share, of the window's height.
class MicroscopePanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit MicroscopePanel(QWidget* parent = nullptr);
  ~MicroscopePanel() override;
  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  void tick();
  void appear();
  void displayNone(const QString& reason);
  void showFindings(const std::optional<cell_microinjection::VisionState>& specimen);

  MicroscopeView* view_;
  PixelGoalBar* goal_;
  FocusBar* focus_;
  std::array<LampRow*, 4> findings_{};
  QTimer* timer_;
  std::unique_ptr<MicroscopeLink> link_;
  sensor_msgs::ImageConstPtr shown_;
  float share_ = 0.5F;
  bool appeared_ = false;
};

}  // namespace microinjection
