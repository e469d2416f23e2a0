#pragma once

#include <Eigen/Core>
#include <vector>

#include "vision/layers/layer_model.h"
#include "vision/layers/layer_samples.h"

namespace microinjection {

/// Fits a LayerModel to samples by Levenberg and Marquardt's steps with Tukey's weights. Sectors of
/// directions whose grey values are unlike the others' (a pipette, a polar body, a dimple) do not count.
class LayerSolver {
 public:
  /// @param ooplasm  first ellipse of the ooplasm
  /// @param rim      px, expected width of the ooplasm's dark rim
  /// @param every    takes each n-th sector only
  /// @param near     parameters whose borders are known: samples far from them are left out; empty: none
  LayerSolver(const LayerSamples& samples, const Ellipse& ooplasm, double rim, int every,
              const Eigen::VectorXd& near = {});

  /// Parameters with the expected widths, borders on their first ellipses, and amplitudes.
  /// @param shift  px, of the ooplasm from its first ellipse, outwards
  Eigen::VectorXd start(const LayerModel& model, double thickness, double shift);
  /// Solves for the amplitudes alone, with the present weights.
  void solveAmplitudes(const LayerModel& model, Eigen::VectorXd& parameters) const;
  /// Robust weights from the residuals of the parameters.
  void weigh(const LayerModel& model, const Eigen::VectorXd& parameters);
  /// @param renew  weighs before each step
  void iterate(const LayerModel& model, Eigen::VectorXd& parameters, int steps, bool renew);
  /// Reduction of chi^2 by an inner border of each thickness low, low + 1, ... (px).
  std::vector<double> scan(const LayerModel& model, const Eigen::VectorXd& parameters, double low, int count) const;

  /// Weighted sum of squares, with the present weights.
  double chi2(const LayerModel& model, const Eigen::VectorXd& parameters) const;
  /// Smaller for better parameters, whatever the weights are: the logarithms of the robust deviations.
  double cost() const;
  Eigen::MatrixXd covariance(const LayerModel& model, const Eigen::VectorXd& parameters);
  /// Number of samples that deviate together.
  double correlated() const;
  /// rms over the band about a border of what the residuals have in common in all directions, and of
  /// what follows the cosine or sine of the direction (grey values): 0 for a model that describes it. `border`: 0
  /// outer, 2 ooplasm.
  double misfit(const LayerModel& model, const Eigen::VectorXd& parameters, int border) const;
  double noise() const { return scale_[0]; }  ///< robust standard deviation outside of the ooplasm
  double used() const { return used_; }       ///< share of the sectors that count

 private:
  struct Point {
    LayerModel::Sample sample;
    double grey;
    int sector;
    bool inside;  ///< of the ooplasm's first ellipse
  };

  double priorWeight(const LayerModel& model, int index) const;
  double priorPlace(int index) const;
  double prior(const LayerModel& model, const Eigen::VectorXd& parameters) const;
  void normal(const LayerModel& model, const Eigen::VectorXd& parameters);
  void rest(const LayerModel& model, const Eigen::VectorXd& parameters, std::vector<double>& rest) const;
  double weighted(const std::vector<double>& rest) const;  ///< sum of squares
  void reweigh();                                          ///< by the present residuals
  /// One damped step that lowers chi^2.
  /// @return px, change of the borders' parameters; negative: no step does
  double step(const LayerModel& model, Eigen::VectorXd& parameters, double& damping);

  std::vector<Point> points_;
  std::vector<double> weight_, residual_, trial_;
  int sectors_;
  double radius_, widths_[5];
  double scale_[2] = {1, 1}, used_ = 0, chi_ = 0;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd right_;
};

}  // namespace microinjection
