#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "cell/contact/pipette_mouth.h"
#include "cell/contact/rounded_tip.h"
#include "cell/pose/cell_motion_config.h"
#include "cell/pose/hold_limits.h"
#include "cell/pose/lip_contact.h"
#include "cell/pose/lip_suction.h"
#include "cell/pose/wall_resistance.h"

namespace microinjection {

/// Where a pipette's own frame (PipetteMouth, RoundedTip) is in the dish's frame, z up.
struct ToolPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  Eigen::Vector3d toDish(const Eigen::Vector3d& own) const { return position + orientation * own; }
  Eigen::Vector3d toOwn(const Eigen::Vector3d& dish) const { return orientation.conjugate() * (dish - position); }
};

/// What acts on the cell during a step; poses are those at its end.
struct CellMotionInput {
  ToolPose mouth;
  double pressure = 0;             ///< Pa, in the holding pipette less that of the bath; < 0 holds
  double notch_area = 0;           ///< m^2, of a leak through the lip
  std::optional<ToolPose> needle;  ///< absent: it does not touch the cell as a rigid body, e.g. because it is inside
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, at the centre: of a needle inside, of a current
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N m, about the centre
};

/// How a cell is; the first that applies.
enum class CellMode {
  kSwallowed,  ///< passed a mouth that is wider than the cell; it then moves with the mouth
  kHeld,       ///< suction presses it on the lip
  kSlipping,   ///< the same, and it slides on the lip at Coulomb's limit
  kLost,       ///< further from the mouth than CellMotionConfig::lost_distance
  kResting,    ///< on the dish
  kFree,
  kCarried  ///< by a needle in it: of CellHold only
};
const char* name(CellMode mode);

/// Contact of the cell with one body, in the dish's frame.
struct CellContactForce {
  double push = 0;                                   ///< N, sum of the normal forces; 0: no contact
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, on the cell; the body feels the opposite
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N m, on the cell, about its centre
  double sliding = 0;                                ///< m/s, mean over the contact, weighted by the normal force
  bool slips = false;  ///< at Coulomb's limit in all of the contact (95 %): a part of it slips long before
};

/// Energies of a step, J. The step's minimum gives: rise <= work - viscous / 2 - friction.
struct CellMotionEnergy {
  double potential = 0;  ///< at its end: weight, contacts, suction and sink, loads
  double work = 0;       ///< change of the potential as the tools and the pressure change, the cell still
  double rise = 0;       ///< change of the potential over the whole step, less that work
  double viscous = 0;    ///< dissipated in the medium
  double friction = 0;   ///< rise of friction's incremental potential: dissipated, less what moving tools lend
};

struct CellMotionState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, of the centre, in the dish's frame
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< rad/s
  CellMode mode = CellMode::kFree;
  bool sealed = false;  ///< the lip touches the cell all round
  CellContactForce lip, dish, needle;
  double suction = 0;          ///< N, towards the middle of the mouth; < 0 when the pipette blows
  double leak = 0;             ///< m^3/s, into the holding pipette
  double seal_resistance = 0;  ///< Pa s/m^3, of the gap between lip and cell; infinite: closed
  double dish_gap = 0;         ///< m, negative: the dish indents the cell
  CellMotionEnergy energy;
  int iterations = 0;             ///< Newton's, of the last step
  const char* refusal = nullptr;  ///< why the last input was not used and the state held; null: it was used
};

/// Motion of a cell as a rigid body in its medium: held, loose, picked up, dropped, rolled by the needle, lost.
///
/// Inertia is negligible (a Reynolds number of 2e-3 at 30 um/s), so the velocity follows from the forces. Only the snap
/// onto a lip, at 0.1 m/s over a micrometre, is faster than that; it takes less than a step. A step of duration h is
/// backward Euler's, as the minimum over the cell's motion z = (translation, R rotation) of
///
///     U(x + dx) + z' M z / (2 h) + sum over contacts of  mu N_i f(|slide_i|) - force dx - torque rotation
///
/// U: weight, dish and needle (Hertz; the needle's end as a sphere of its edge's radius), LipContact, LipSuction.
/// M: WallResistance at the gap of the step's begin. f: |slide|, rounded below creep_speed * h (Li et al., "Incremental
/// potential contact", ACM Trans. Graph. 39 (2020) 49). N_i and the normals are of the previous solution of the same
/// step, until two agree. The alternatives were explicit steps, which the contacts' stiffness (1 N/m
/// against a drag of 1e-6 N s/m) limits to microseconds, and Newton's method on the complementarity problem, which may
/// fail. A minimum is always found, and bounds the energy: what the cell gains the tools have lent. Hence no step of a
/// tool makes it unstable, however long; one longer than a fifth of the radius is cut so that a tip does not jump
/// through the cell.
///
/// Frames: all poses in the dish's, z up. The step allocates nothing. Not thread-safe.
class CellMotion {
 public:
  /// Throws ConfigError. @param tip of the needle, @param mouth of the holding pipette; neither need be there.
  CellMotion(const CellMotionConfig& config, const std::optional<PipetteMouth>& mouth,
             const std::optional<RoundedTip>& tip);

  /// Puts the cell there, at rest, with the tools where they are. False, and nothing happens, when a number is not
  /// finite: see state().refusal.
  bool place(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation, const CellMotionInput& input);

  /// An input that is not finite, or of a tool that is not there, is refused: the state is held, and says so.
  /// @param duration s, > 0
  const CellMotionState& step(double duration, const CellMotionInput& input);

  const CellMotionState& state() const { return state_; }
  const CellMotionConfig& config() const { return config_; }

  /// N/m^(3/2), of force over overlap^(3/2) at the needle, from the next step on: Hertz's is that of small dents.
  void setNeedleStiffness(double stiffness) { needle_stiffness_ = stiffness; }
  double hertzNeedleStiffness() const { return hertz_needle_stiffness_; }

  /// What the mouth can hold at a pressure (Pa; only suction holds). Nothing without a mouth, or when it is wider than
  /// the cell. Of a soft cell, whose seat yields (LipSuction).
  HoldLimits limits(double pressure, double notch_area = 0) const;

 private:
  using Motion = Eigen::Matrix<double, 6, 1>;  ///< m: translation, and rotation times the radius
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  /// Coulomb's friction at a point of the sphere.
  struct Friction {
    Eigen::Matrix<double, 2, 6> tangents;  ///< of the slide, in the plane of contact, by the motion
    Eigen::Vector2d shift;                 ///< m, of the other body there in this step
    double limit;                          ///< N
    CellContactForce CellMotionState::*contact;

    Eigen::Vector2d slide(const Motion& motion) const { return tangents * motion - shift; }
  };
  struct Potential {
    double energy = 0;
    Motion gradient = Motion::Zero();
    Matrix6 convex = Matrix6::Zero();                   ///< positive semi-definite part of the Hessian
    Eigen::Matrix3d concave = Eigen::Matrix3d::Zero();  ///< the rest, of the translation
  };

  const char* refusal(const CellMotionInput& input) const;
  void carry(const CellMotionInput& input);
  void substep(double duration, const CellMotionInput& input);
  void prepare(double duration);
  /// U at a motion, and with what the step adds.
  Potential potential(const Motion& motion) const;
  Potential increment(const Motion& motion) const;
  void addContacts(const Eigen::Vector3d& at, Potential& sum) const;
  void addSuction(const Eigen::Vector3d& at, Potential& sum) const;
  void addFriction(const Motion& motion, Potential& sum) const;
  double frictionPotential(const Motion& motion) const;
  double gather(const Motion& motion, bool first);
  void minimise(double duration, Motion& motion);
  void finish(double duration, const Motion& motion);
  void report(double duration, const Motion& motion);
  Eigen::Vector3d middle() const;
  CellMode mode() const;

  CellMotionConfig config_;
  std::optional<PipetteMouth> mouth_;
  std::optional<RoundedTip> tip_;
  std::optional<LipContact> lip_;
  std::optional<LipSuction> suction_;
  const WallResistance* wall_;                                                 ///< one for all cells
  double dish_stiffness_, hertz_needle_stiffness_ = 0, needle_stiffness_ = 0;  ///< N/m^(3/2)

  CellMotionState state_;
  bool swallowed_ = false;
  CellMotionInput now_, before_;  ///< at the end of this and of the last step
  // Of the current step:
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();
  Matrix6 resistance_ = Matrix6::Zero();  ///< N/m: over the duration
  double rounding_ = 0;                   ///< m, slide at which friction reaches its limit
  double notch_ = 0, gap_shift_ = 0;      ///< m^3/(Pa s); m, of the gap that leaks from the mean one
  double sink_ = 0;                       ///< N m^2, of the drag of the flow into the mouth
  double tolerance_ = 0;                  ///< N
  std::array<Friction, LipContact::kPoints + 2> frictions_;
  int friction_count_ = 0;
};

}  // namespace microinjection
