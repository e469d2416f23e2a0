#pragma once

#include <QWidget>
#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "rviz/microscope_link.h"

namespace microinjection {

class FocusBar;
class LampRow;
class MicroscopeView;
class PixelGoalBar;

/// The microscope's image, and what vision found in it. A click proposes a place for the tip, which the needle is led
/// to after Go; the focus is moved by steps.
class MicroscopeWidget : public QWidget {
 public:
  static constexpr int kPeriod = 66;  ///< ms, of tick(): 15 Hz, as the scene

  /// `appear` is called with the first node that publishes images.
  explicit MicroscopeWidget(std::function<void()> appear, QWidget* parent = nullptr);
  ~MicroscopeWidget() override;
  /// Connects to the session. The bus must outlive this widget.
  void start(Bus& bus);
  /// Handles the messages that came, and shows the newest.
  void tick();

 private:
  void displayNone(const QString& reason);
  void showFindings(const std::optional<cell_microinjection::VisionState>& specimen);

  std::function<void()> appear_;
  bool appeared_ = false;
  MicroscopeView* view_;
  PixelGoalBar* goal_;
  FocusBar* focus_;
  std::array<LampRow*, 4> findings_{};
  std::unique_ptr<MicroscopeLink> link_;
  sensor_msgs::ImageConstPtr shown_;
};

}  // namespace microinjection
