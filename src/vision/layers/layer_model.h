#pragma once

#include <Eigen/Core>
#include <vector>
#include "vision/frame/contrast_mode.h"

namespace microinjection {

/// The grey values of a cell with a zona across its borders, as an objective in focus images them. LayerSolver fits
/// the model to all grey values about the borders at once.
///
///     grey  ----.   .--------.   .------.        .-.
///                \ /          \ /        \      /   '---.___
///                 v            v          '----'            ramp
///            outer border  inner border   rim  | bright line
///     medium |    zona     |     gap           ooplasm            --> inwards
///
/// Lines that are searched one by one are lost where the ooplasm's dark rim covers the zona's inner border. A model
/// of all of them knows how much the rim and the outer border explain, so that the inner border is what remains; and
/// it says how well each place is determined. The lines, in detail:
///
/// - Each border is a step of the grey value with a line along it, a box of some width. The line of the zona's
///   borders is symmetric to them; the ooplasm has a dark rim outside and a bright line inside.
/// - One Gaussian blur holds for all, because one objective images them. Fringes of a phase object out of focus are
///   not in the model, so that 10 um out of focus no diameter is sure (doc/design/detection.md).
/// - In DIC each border also has a line whose amplitude follows the cosine of the direction to the shear, which is
///   free; in phase contrast the steps of outer border and ooplasm have a halo.
///
/// The value at `place` px outside of the base, in the direction a, is
///
///     sum over terms i:  amplitude_i h_i(a) f_i(distance to the term's border; width, blur),   h = 1, cos a or sin a
///
/// It is linear in the amplitudes, of which a contrast mode has 9 to 19. Given the shapes, they follow from linear
/// equations (LayerSolver::solveAmplitudes), so that only the shapes need a first guess. Blurred edges come from a
/// table, because the error function took most of a fit's time. Parameters are one vector: shapes first, then the
/// amplitudes in the order of the terms.
class LayerModel {
 public:
  /// Parameters before the amplitudes. Places are px outwards, of the outer border from the base of the samples (an
  /// ellipse), of the ooplasm from its first ellipse: harmonics 1, cos, sin, cos 2, sin 2 of the direction, which are
  /// radius, centre and ellipse to first order. The thickness of the zona has only 1, cos and sin, because a zona is
  /// nearly as thick everywhere. Widths of lines and blur (standard deviation): px; those of the zona's lines are
  /// half of the line.
  ///
  ///     0     5      8     13          14          15    16           17     18 = kShapes
  ///     outer thick. oopl. outer line, inner line, rim,  bright line, blur | amplitudes
  enum Index {
    kOuter = 0,
    kThickness = 5,
    kOoplasm = 8,
    kOuterLine = 13,
    kInnerLine,
    kRim,
    kBrightLine,
    kBlur,
    kShapes
  };
  /// Parameters of amplitudes, in grey values of full scale; negative: dark. They count the terms of the constructor;
  /// that of the inner line exists with `inner` only.
  enum Amplitude { kOuterLineDepth = kShapes + 4, kRimDepth = kShapes + 6, kInnerLineDepth = kShapes + 9 };

  /// Of a direction (rad).
  struct Harmonics {
    double at[5];  ///< 1, cos, sin, cos 2, sin 2
    explicit Harmonics(double direction);
    double sum(const Eigen::VectorXd& parameters, int first, int count) const;  ///< of parameters from `first` on
  };
  struct Sample {
    Harmonics harmonics;
    double place = 0;    ///< px from the base
    double radius = 0;   ///< px of the base
    double ooplasm = 0;  ///< px, place of the ooplasm's first ellipse from the base
  };

  /// @param inner  false: a model without the zona's inner border
  LayerModel(ContrastMode mode, bool inner);

  /// Number of parameters, and of terms.
  int size() const { return kShapes + static_cast<int>(terms_.size()); }
  int terms() const { return static_cast<int>(terms_.size()); }
  bool hasInner() const { return inner_; }
  /// Size (grey values) of the lines of a border, 0 outer, 1 inner, 2 ooplasm: with those of DIC.
  double contrast(const Eigen::VectorXd& parameters, int border) const;
  /// Standard deviation (grey values of full scale) that a term's amplitude is expected to have.
  double usualAmplitude(int term) const;

  /// Values of the terms() terms, whose weights are the amplitudes.
  void terms(const Eigen::VectorXd& parameters, const Sample& sample, double* values) const;
  /// Indices of the terms of the zona's inner border, and their values times `weight`.
  const std::vector<int>& innerTerms() const { return inner_terms_; }
  void innerTerms(const Eigen::VectorXd& parameters, const Sample& sample, double weight, double* values) const;
  double value(const Eigen::VectorXd& parameters, const Sample& sample) const;
  /// The same with its derivatives for all parameters, size() of them.
  double value(const Eigen::VectorXd& parameters, const Sample& sample, Eigen::VectorXd& slope) const;

 private:
  enum class Kind { kOne, kTilt, kStep, kLine, kOutside, kInside, kRamp, kHalo };
  struct Term {
    Kind kind;
    int border;    ///< 0 outer, 1 inner, 2 ooplasm
    int harmonic;  ///< 0: none, 1: cos, 2: sin of the direction
    int width;     ///< index of its width in the parameters
  };
  struct Response {
    double value = 0, distance = 0, width = 0, blur = 0;  ///< and its derivatives
  };
  struct Edge {
    double rise = 0, density = 0;  ///< 0..1 inwards, and its derivative
  };
  /// The borders' distances from a sample, the edges there, and the last response.
  struct Place {
    double distance[3];
    Edge edge[3];
    const Term* last = nullptr;
    Response response;
  };
  static Edge edgeAt(double distance, double blur);
  /// Without derivatives the value alone, in half of the time.
  template <bool derivatives>
  static Response respond(Kind kind, double distance, const Edge& edge, double width, double blur);
  Place placeOf(const Eigen::VectorXd& parameters, const Sample& sample) const;
  /// Of a term, without its harmonic. Terms that differ in that only have the same.
  template <bool derivatives>
  static const Response& respond(const Eigen::VectorXd& parameters, const Term& term, const Sample& sample,
                                 Place& place);

  bool inner_;
  std::vector<Term> terms_;
  std::vector<int> inner_terms_;
};

}  // namespace microinjection
