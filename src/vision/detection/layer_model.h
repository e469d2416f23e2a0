#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// The grey values of a cell with a zona across its borders, as an objective in focus images them.
///
/// Each border is a step of the grey value with a line along it: the line of the zona's borders is
/// symmetric to them, the ooplasm has a dark rim outside and a bright line inside. One Gaussian blur
/// holds for all. In DIC each border also has a line whose amplitude follows the cosine of the
/// direction to the shear, which is free; in phase contrast the steps also have a halo.
class LayerModel {
 public:
  /// Parameters before the amplitudes. Places are px from the base of the samples: outer border and
  /// ooplasm as harmonics 1, cos, sin, cos 2, sin 2 of the direction, thickness of the zona as 1, cos,
  /// sin. Widths of lines and blur (standard deviation): px.
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
  /// Parameters of the amplitudes that every look has, in grey values.
  enum Amplitude { kOuterLineDepth = kShapes + 4, kRimDepth = kShapes + 6, kInnerLineDepth = kShapes + 9 };

  struct Harmonics {
    double at[5];  ///< 1, cos, sin, cos 2, sin 2
    explicit Harmonics(double direction);
    double sum(const Eigen::VectorXd& parameters, int first, int count) const;
  };
  struct Sample {
    Harmonics harmonics;
    double place = 0;    ///< px from the base
    double radius = 0;   ///< px of the base
    double ooplasm = 0;  ///< px, place of the ooplasm's first ellipse from the base
  };

  /// @param inner  false: a model without the zona's inner border
  LayerModel(const std::string& look, bool inner);

  int size() const { return kShapes + static_cast<int>(terms_.size()); }
  int terms() const { return static_cast<int>(terms_.size()); }
  bool hasInner() const { return inner_; }
  /// Size (grey values) of the lines of a border, 0 outer, 1 inner, 2 ooplasm: with those of DIC.
  double contrast(const Eigen::VectorXd& parameters, int border) const;
  /// Standard deviation (grey values of full scale) that a term's amplitude is expected to have.
  double usualAmplitude(int term) const;

  /// Values of the terms, whose weights are the amplitudes.
  void terms(const Eigen::VectorXd& parameters, const Sample& sample, double* values) const;
  /// Indices of the terms of the zona's inner border, and their values times `weight`.
  const std::vector<int>& innerTerms() const { return inner_terms_; }
  void innerTerms(const Eigen::VectorXd& parameters, const Sample& sample, double weight, double* values) const;
  double value(const Eigen::VectorXd& parameters, const Sample& sample) const;
  /// The same with its derivatives for all parameters.
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
