#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// What a needle that rubs or adheres feels less on its way out than it felt on its way in, along the axis, as a
/// function of the depth and of the depth at which it has turned. Depths (m) are from first contact into the cell. Over
/// the force at the turn, because that share varies little from cell to cell.
///
///     force
///      |                 . '  way in
///      |            . '  .
///      |        . '   .   way out: less by share() of the force at the turn
///      |    . '    .
///     -+--.-----.--------|--> depth
///      |'.  . '         turn
///      |  '.'  pull of adhesion, largest at -pull_depth, half of that `fall` further out
class WithdrawalLoss {
 public:
  static constexpr int kKnots = 24;
  /// (1 + x) exp(-x) = 1/2: the pull over x behind its largest, where x is 1 for a traction's range (RigidContact).
  static constexpr double kHalfway = 1.678347;

  struct Turn {
    double depth = 0;        ///< m, > 0, at which the needle has turned
    double pull_depth = 0;   ///< m, >= 0, above first contact, where adhesion pulls most
    double fall = 0;         ///< m, > 0, over which the pull then falls to half
    double force = 0;        ///< > 0, at the turn, in any unit that the turns share
    Eigen::VectorXd shares;  ///< >= 0, of the force at the turn, at kKnots depths: depthOf()
  };

  /// @param turns ascending; between them the loss itself is interpolated, since adhesion's share falls as the force
  /// rises; beyond them the shares stay
  /// @param error one of ten has more, over the force at the turn
  /// @throws std::invalid_argument for fewer than three turns or another number of shares
  WithdrawalLoss(const std::vector<Turn>& turns, double error);

  /// Of knot `i`, m: from the largest pull to the turn, closer together above.
  static double depthOf(int i, double turn, double pull_depth);

  /// >= 0, of the force at the turn. Does not allocate.
  double share(double depth, double turn) const;
  /// m, above first contact, where nothing adheres any more; 0 without adhesion.
  double reach(double turn) const;
  double error() const { return error_; }

 private:
  static constexpr int kTurns = 33, kPlaces = 49;
  struct Row {
    double pull_depth = 0, fall = 0;
    Eigen::Matrix<double, kPlaces, 1> shares;
  };
  struct Between {
    int row;
    double part;  ///< of the row after it
  };
  Between find(double turn) const;

  std::vector<Row> rows_;  ///< at equal steps of the root of the turn
  double first_, last_;    ///< roots of turns
  double error_;
};

}  // namespace microinjection
