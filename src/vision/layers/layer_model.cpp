#include "vision/layers/layer_model.h"

#include <array>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kHaloBlur = 16;     // px rms, of the halo of phase contrast
constexpr double kShadedLine = 1;    // px, half the width of a line of DIC before it is blurred
constexpr double kRampLength = 10;   // px, on which the ooplasm darkens by a ramp's amplitude
constexpr double kTiltLength = 100;  // px, on which the illumination changes by a tilt's amplitude
constexpr int kPerBlur = 128;        // entries of the table of a blurred edge
constexpr double kTableReach = 5;    // blurs, beyond which an edge is its limit

void placeBorders(const Eigen::VectorXd& p, const LayerModel::Sample& sample, double* distance) {
  const double outer = sample.harmonics.sum(p, LayerModel::kOuter, 5) - sample.place;
  distance[0] = outer;
  distance[1] = outer - sample.harmonics.sum(p, LayerModel::kThickness, 3);
  distance[2] = sample.ooplasm + sample.harmonics.sum(p, LayerModel::kOoplasm, 5) - sample.place;
}

double tiltAt(const LayerModel::Sample& sample) { return (sample.radius + sample.place) / kTiltLength; }

}  // namespace

LayerModel::Harmonics::Harmonics(double direction) {
  const double c = std::cos(direction), s = std::sin(direction);
  at[0] = 1;
  at[1] = c;
  at[2] = s;
  at[3] = c * c - s * s;
  at[4] = 2 * c * s;
}

double LayerModel::Harmonics::sum(const Eigen::VectorXd& parameters, int first, int count) const {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += parameters[first + i] * at[i];
  return sum;
}

LayerModel::LayerModel(ContrastMode mode, bool inner) : inner_(inner) {
  terms_ = {{Kind::kOne, 0, 0, -1},       {Kind::kTilt, 0, 1, -1},           {Kind::kTilt, 0, 2, -1},
            {Kind::kStep, 0, 0, -1},      {Kind::kLine, 0, 0, kOuterLine},   {Kind::kStep, 2, 0, -1},
            {Kind::kOutside, 2, 0, kRim}, {Kind::kInside, 2, 0, kBrightLine}};
  if (inner) {
    terms_.push_back({Kind::kStep, 1, 0, -1});
    terms_.push_back({Kind::kLine, 1, 0, kInnerLine});
  }
  terms_.push_back({Kind::kRamp, 2, 0, -1});
  if (mode == ContrastMode::kPhase) {
    for (const int border : {0, 2}) terms_.push_back({Kind::kHalo, border, 0, -1});
  }
  if (mode == ContrastMode::kDic) {
    // Terms that differ in their harmonic only are neighbours: their response is computed once.
    for (const int border : {0, 1, 2}) {
      for (const int harmonic : {1, 2}) {
        if (border != 1 || inner) terms_.push_back({Kind::kLine, border, harmonic, -1});
      }
    }
    for (const int harmonic : {1, 2}) terms_.push_back({Kind::kRamp, 2, harmonic, -1});
  }
  for (int i = 0; i < terms(); ++i) {
    if (terms_[static_cast<std::size_t>(i)].border == 1) inner_terms_.push_back(i);
  }
}

double LayerModel::contrast(const Eigen::VectorXd& parameters, int border) const {
  double square = 0;
  for (int i = 0; i < terms(); ++i) {
    const Term& term = terms_[static_cast<std::size_t>(i)];
    const bool line = term.kind == Kind::kLine || term.kind == Kind::kOutside;
    if (line && term.border == border) square += parameters[kShapes + i] * parameters[kShapes + i];
  }
  return std::sqrt(square);
}

double LayerModel::usualAmplitude(int term) const {
  const Term& it = terms_[static_cast<std::size_t>(term)];
  if (it.kind == Kind::kOne) return 10;
  return it.kind == Kind::kLine ? 0.1 : 0.2;
}

/// A step that is blurred by a Gaussian, from a table: the error function took most of a fit's time.
LayerModel::Edge LayerModel::edgeAt(double distance, double blur) {
  static const auto table = [] {
    std::array<Edge, 2 * static_cast<std::size_t>(kTableReach * kPerBlur) + 2> entries;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const double u = static_cast<double>(i) / kPerBlur - kTableReach;
      entries[i] = {0.5 * std::erfc(-u * M_SQRT1_2), std::exp(-0.5 * u * u) / std::sqrt(2 * M_PI)};
    }
    return entries;
  }();
  const double u = distance / blur;
  if (u >= kTableReach) return {1, 0};
  if (u <= -kTableReach) return {0, 0};
  const double place = (u + kTableReach) * kPerBlur;
  const auto i = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(i);
  const Edge &a = table[i], &b = table[i + 1];
  return {a.rise + t * (b.rise - a.rise), (a.density + t * (b.density - a.density)) / blur};
}

template <bool derivatives>
LayerModel::Response LayerModel::respond(Kind kind, double distance, const Edge& edge, double width, double blur) {
  const auto box = [&](double first, double last, double first_slope, double last_slope) {
    const Edge a = first == 0 ? edge : edgeAt(distance - first, blur);
    const Edge b = last == 0 ? edge : edgeAt(distance - last, blur);
    if constexpr (!derivatives) return Response{a.rise - b.rise, 0, 0, 0};
    return Response{a.rise - b.rise, a.density - b.density, last_slope * b.density - first_slope * a.density,
                    ((distance - last) * b.density - (distance - first) * a.density) / blur};
  };
  switch (kind) {
    case Kind::kLine:
      return box(-width, width, -1, 1);
    case Kind::kOutside:
      return box(-width, 0, -1, 0);
    case Kind::kInside:
      return box(0, width, 0, 1);
    case Kind::kStep:
      return {edge.rise, edge.density, 0, derivatives ? -distance / blur * edge.density : 0};
    case Kind::kHalo: {
      const Edge halo = edgeAt(distance, kHaloBlur);
      return {halo.rise, halo.density, 0, 0};
    }
    case Kind::kRamp:
      return {(distance * edge.rise + blur * blur * edge.density) / kRampLength, edge.rise / kRampLength, 0,
              blur * edge.density / kRampLength};
    default:
      return {1, 0, 0, 0};
  }
}

LayerModel::Place LayerModel::placeOf(const Eigen::VectorXd& p, const Sample& sample) const {
  Place place;
  placeBorders(p, sample, place.distance);
  for (const int border : {0, 1, 2}) {
    if (border != 1 || inner_) place.edge[border] = edgeAt(place.distance[border], p[kBlur]);
  }
  return place;
}

template <bool derivatives>
const LayerModel::Response& LayerModel::respond(const Eigen::VectorXd& p, const Term& term, const Sample& sample,
                                                Place& place) {
  const Term* const last = place.last;
  place.last = &term;
  if (last && last->kind == term.kind && last->border == term.border && last->width == term.width)
    return place.response;
  const double width = term.width < 0 ? kShadedLine : p[term.width];
  place.response = term.kind == Kind::kTilt ? Response{tiltAt(sample), 0, 0, 0}
                                            : respond<derivatives>(term.kind, place.distance[term.border],
                                                                   place.edge[term.border], width, p[kBlur]);
  return place.response;
}

void LayerModel::terms(const Eigen::VectorXd& p, const Sample& sample, double* values) const {
  Place place = placeOf(p, sample);
  for (const Term& term : terms_)
    *values++ = sample.harmonics.at[term.harmonic] * respond<false>(p, term, sample, place).value;
}

void LayerModel::innerTerms(const Eigen::VectorXd& p, const Sample& sample, double weight, double* values) const {
  Place place;
  placeBorders(p, sample, place.distance);
  place.edge[1] = edgeAt(place.distance[1], p[kBlur]);
  for (const int i : inner_terms_) {
    const Term& term = terms_[static_cast<std::size_t>(i)];
    *values++ = weight * sample.harmonics.at[term.harmonic] * respond<false>(p, term, sample, place).value;
  }
}

double LayerModel::value(const Eigen::VectorXd& p, const Sample& sample) const {
  double values[32], sum = 0;
  terms(p, sample, values);
  for (int i = 0; i < terms(); ++i) sum += p[kShapes + i] * values[i];
  return sum;
}

double LayerModel::value(const Eigen::VectorXd& p, const Sample& sample, Eigen::VectorXd& slope) const {
  double moved[3] = {0, 0, 0}, sum = 0;
  Place place = placeOf(p, sample);
  const double* const harmonic = sample.harmonics.at;
  slope.setZero(size());
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const Term& term = terms_[i];
    const int index = kShapes + static_cast<int>(i);
    const double weight = harmonic[term.harmonic];
    const Response& response = respond<true>(p, term, sample, place);
    slope[index] = weight * response.value;
    sum += p[index] * slope[index];
    const double amplitude = p[index] * weight;
    moved[term.border] += amplitude * response.distance;
    slope[kBlur] += amplitude * response.blur;
    if (term.width >= 0) slope[term.width] += amplitude * response.width;
  }
  for (int i = 0; i < 5; ++i) {
    slope[kOuter + i] = (moved[0] + moved[1]) * harmonic[i];
    slope[kOoplasm + i] = moved[2] * harmonic[i];
  }
  for (int i = 0; i < 3; ++i) slope[kThickness + i] = -moved[1] * harmonic[i];
  return sum;
}

}  // namespace microinjection
