#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cell/family/family_data.h"
#include "cell/model/live_cell.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {

/// The forces of one scene's cell for a program that asks for them: by the model that a session would serve. A session
/// has a clock, and its cell may answer late; a program waits for each force, so a live cell's is always that of its
/// equilibrium. Any number of threads may call the functions that are const.
///
///     model        a force costs       each tip
///     surrogate    a microsecond       is evaluated from the surrogate data
///     live         0.05 to 0.5 s       is solved from the touch on
class ServedForces {
 public:
  /// @param model     auto, surrogate or live, as in a session file
  /// @param families  folder
  /// @throws ConfigError when the model cannot serve the scene
  ServedForces(std::shared_ptr<const Scene> scene, const std::string& model, const std::string& families);

  /// What is asked for at each tip; not a number where the cell has no valid force.
  struct Wanted {
    double* forces = nullptr;       ///< 3 for each tip, N, of the cell on the tip; null: not wanted
    double* stiffnesses = nullptr;  ///< 9 for each tip, N/m, by rows: the force changes by -stiffness dx
  };
  /// @param tips      m, in the cell's frame
  /// @param along     the tips are successive places of one needle, whose contact begins where it touches; else each is
  ///                  reached by itself, straight down
  /// @param progress  called now and then; may throw
  void evaluate(const Eigen::Ref<const Eigen::Matrix3Xd>& tips, bool along, const Wanted& wanted,
                void (*progress)()) const;

  struct Surface {
    Eigen::Matrix3Xd at_rest, vertices;  ///< m
    std::vector<std::array<int, 3>> triangles;
  };
  Surface surface(const Eigen::Vector3d& tip) const;

  /// Why a needle along this axis cannot be served; empty: it can.
  std::string refusal(const Eigen::Vector3d& axis) const;
  bool isLive() const { return live_ != nullptr; }
  const std::string& description() const { return description_; }
  /// Of the force, relative: median, and what one of ten has more than; empty: not known.
  std::optional<std::pair<double, double>> expectedError() const;
  const std::shared_ptr<const FamilyData>& family() const { return family_; }
  const Scene& scene() const { return *scene_; }

 private:
  void evaluateSurrogate(SurrogateContact& contact, const Eigen::Ref<const Eigen::Matrix3Xd>& tips, bool along,
                         const Wanted& wanted) const;
  void evaluateLive(const Eigen::Ref<const Eigen::Matrix3Xd>& tips, bool along, const Wanted& wanted,
                    void (*progress)()) const;

  std::shared_ptr<const Scene> scene_;
  double glued_error_ = 0;                     ///< see ServingPlan
  std::shared_ptr<const SurrogateData> data_;  ///< null: live
  std::shared_ptr<const FamilyData> family_;   ///< that contains the scene; null: none
  std::shared_ptr<const LiveCell> live_;
  std::string description_;
  /// A contact costs more to make than a force. A call that finds it in use makes one of its own.
  mutable std::mutex contact_mutex_;
  mutable std::unique_ptr<SurrogateContact> contact_;
};

}  // namespace microinjection
