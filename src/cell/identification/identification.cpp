#include "cell/identification/identification.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include "base/errors.h"
#include "base/median.h"
#include "cell/identification/contact_guess.h"
#include "cell/identification/frozen_readings.h"
#include "cell/identification/profile_interval.h"

namespace microinjection {
namespace {

constexpr std::size_t kMostSamples = 2000;
constexpr double kDeviations95 = 1.96;
constexpr double kTrimmed = 0.02;
constexpr double kInseparable = 0.97;         ///< correlation of two unknowns
constexpr double kLeastMisfit = 0.03;         ///< of the force: a smaller one is no reason to doubt a model
constexpr double kSignificant = 3;            ///< misfit over what noise alone would leave
constexpr std::size_t kEnoughInContact = 60;  ///< that are left of a long record
constexpr std::size_t kFewestInContact = 24;
constexpr double kKnown = 0.1;                 ///< of the samples: a shorter contact is known coarsely
constexpr std::size_t kFewestSearched = 1000;  ///< samples, at the end of a record, in which a contact is looked for
constexpr int kBlocks = 12;                    ///< of the part in contact, whose means are its smooth part

/// Deviation of a sample, from its neighbours: no model changes it. A converter's step adds its rounding.
double whiteNoise(const ForceCurve& curve) {
  std::vector<double> differences;
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i + 1 < curve.size(); ++i) {
    differences.push_back(std::abs(curve.force[i] - 0.5 * (curve.force[i - 1] + curve.force[i + 1])));
    const double change = std::abs(curve.force[i] - curve.force[i - 1]);
    if (change > 0) step = std::min(step, change);
  }
  const double rounding = std::isfinite(step) ? step / std::sqrt(12) : 0;
  return std::max(1.4826 / std::sqrt(1.5) * upperMedian(std::move(differences)), rounding);
}

/// Rms of the blocks' medians of the residuals in contact, and what noise alone leaves of it.
struct Misfit {
  double found = 0, expected = 0;
};

Misfit misfitOf(const ForceCurve& curve, const Eigen::VectorXd& residuals, double contact, double noise) {
  std::vector<double> inside;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve.position[i] > contact) inside.push_back(residuals[static_cast<Eigen::Index>(i)]);
  }
  if (inside.size() < kFewestInContact) {
    throw ConfigError("only " + std::to_string(inside.size()) + " samples are in contact: must be at least " +
                      std::to_string(kFewestInContact));
  }
  const std::size_t length = inside.size() / kBlocks;
  double squares = 0;
  for (int block = 0; block < kBlocks; ++block) {
    const auto begin = inside.begin() + static_cast<std::ptrdiff_t>(block * length);
    const double middle = upperMedian({begin, begin + static_cast<std::ptrdiff_t>(length)});
    squares += middle * middle;
  }
  return {std::sqrt(squares / kBlocks), 1.25 * noise / std::sqrt(static_cast<double>(length))};
}

double trimmedDeviation(const Eigen::VectorXd& residuals) {
  std::vector<double> squares(static_cast<std::size_t>(residuals.size()));
  Eigen::Map<Eigen::VectorXd>(squares.data(), residuals.size()) = residuals.cwiseAbs2();
  std::sort(squares.begin(), squares.end());
  const auto kept = static_cast<std::size_t>((1 - kTrimmed) * static_cast<double>(squares.size()));
  double sum = 0;
  for (std::size_t i = 0; i < kept; ++i) sum += squares[i];
  return std::sqrt(sum / static_cast<double>(kept));
}

std::vector<std::string> inseparable(const CurveModel& model, const CurveFit& fit) {
  std::vector<std::string> result;
  const auto& unknowns = model.unknowns();
  for (std::size_t p = 0; p < unknowns.size(); ++p) {
    for (std::size_t q = 0; q < p; ++q) {
      const auto i = static_cast<Eigen::Index>(p), j = static_cast<Eigen::Index>(q);
      const double scale = std::sqrt(fit.covariance(i, i) * fit.covariance(j, j));
      const double correlation = scale > 0 ? fit.covariance(i, j) / scale : 0;
      if (std::abs(correlation) < kInseparable) continue;
      char text[200];
      std::snprintf(text, sizeof(text), "%s and %s cannot be told apart by this record (correlation %.3f)",
                    unknowns[q].name.c_str(), unknowns[p].name.c_str(), correlation);
      result.emplace_back(text);
    }
  }
  return result;
}

Eigen::VectorXd residualsOf(CurveModel& model, const Eigen::VectorXd& internal) {
  Eigen::VectorXd force;
  Eigen::MatrixXd jacobian;
  model.predict(internal, force, jacobian);
  return Eigen::Map<const Eigen::VectorXd>(model.curve().force.data(), force.size()) - force;
}

/// It ends at the borders of the search.
ProfileInterval curvatureInterval(const CurveModel::Unknown& unknown, double found, double deviation) {
  const double low = found - kDeviations95 * deviation, high = found + kDeviations95 * deviation;
  return {std::max(low, unknown.low), std::min(high, unknown.high), low >= unknown.low, high <= unknown.high};
}

/// @param scale of the force and the law, relative: half of its interval of 95 %
Estimate estimateOf(CurveModel& model, const CurveFit& fit, int p, double correlation, double scale, bool profile) {
  const CurveModel::Unknown& unknown = model.unknowns()[static_cast<std::size_t>(p)];
  const double deviation = std::sqrt(correlation * fit.covariance(p, p));
  ProfileInterval interval = curvatureInterval(unknown, fit.internal[p], deviation);
  if (profile && deviation > 0) interval = profileInterval(model, fit, p, 0.5 * kChiSquared95 * correlation, deviation);
  // What law and sensor are off by is the modulus's, too.
  if (unknown.name == "young_modulus") {
    interval.low = fit.internal[p] - std::hypot(fit.internal[p] - interval.low, scale);
    interval.high = fit.internal[p] + std::hypot(interval.high - fit.internal[p], scale);
  }
  return {unknown.name,
          unknown.unit,
          unknown.si(fit.internal[p]),
          unknown.si(interval.low),
          unknown.si(interval.high),
          interval.bounded_below,
          interval.bounded_above};
}

/// The law with the parameters of the best fit, against the rivals.
RivalComparison compared(const CurveModel& model, const CurveFit& fit, double noise, const IdentificationConfig& known,
                         bool drift) {
  const ForceCurve& curve = model.curve();
  const auto count = static_cast<Eigen::Index>(curve.size());
  AxisSamples samples;
  samples.time = Eigen::Map<const Eigen::VectorXd>(curve.time.data(), count);
  samples.travel = Eigen::Map<const Eigen::VectorXd>(curve.position.data(), count);
  samples.force = Eigen::Map<const Eigen::VectorXd>(curve.force.data(), count);
  samples.deviation = Eigen::VectorXd::Constant(count, noise);
  const auto value = [&](const char* name) {
    const int p = model.index(name);
    return model.unknowns()[static_cast<std::size_t>(p)].si(fit.internal[p]);
  };
  ShapeFit start;
  start.modulus = value("young_modulus");
  start.contact = value("contact");
  start.offset = value("offset");
  start.drift = drift ? value("drift") : 0;
  ShapeFitConfig config;
  config.drift = drift;
  config.contact = known.contact;
  config.contact_deviation = known.contact_deviation;
  Eigen::VectorXd none;
  const AxisShape shape([&](double depth) { return model.law().force(depth, none).force; }, model.law().deepest());
  return compareWithRivals({shape, model.law().error()}, *known.rivals, samples, config, start);
}

/// `drift`: of the sensor.
Identification identifyWith(const ForceCurve& curve, const std::shared_ptr<ElasticLaw>& law,
                            const IdentificationConfig& config, bool drift) {
  const ContactGuess guess = guessContact(curve, drift);
  if (!guess.touched) throw ConfigError(guess.reason + (drift ? "; a drift is allowed for, see --drift off" : ""));
  Eigen::VectorXd none;
  const bool rises = std::is_sorted(curve.time.begin(), curve.time.end(), std::less_equal<>());
  if (config.prony_terms > 0 && !(curve.timed && rises)) {
    throw ConfigError("--prony = " + std::to_string(config.prony_terms) + ": the record must have a time that rises");
  }
  CurveModel model(curve, law, {drift, config.prony_terms});
  model.start(guess.size / law->force(guess.depth, none).force, guess.contact, guess.offset, guess.drift);
  const CurveFit fit = fitCurveAndNoise(model, guess.noise);
  if (!fit.converged) throw ConfigError("the fit does not converge: " + fit.reason);

  Identification result;
  result.model = law->description();
  result.noise = fit.noise;
  result.residuals = residualsOf(model, fit.internal);
  constexpr double kDeviationOfMedian = 1.4826;  // of normal values, over the median of their sizes
  const double scale =
      std::hypot(kDeviations95 * kDeviationOfMedian * law->error(), std::log1p(config.calibration_error));
  const double correlation = correlationLength(result.residuals.cwiseMax(-5 * fit.noise).cwiseMin(5 * fit.noise));
  result.independent = static_cast<double>(curve.size()) / correlation;
  for (std::size_t p = 0; p < model.unknowns().size(); ++p) {
    if (model.unknowns()[p].low == model.unknowns()[p].high) continue;
    result.estimates.push_back(estimateOf(model, fit, static_cast<int>(p), correlation, scale, config.intervals));
    const Estimate& last = result.estimates.back();
    if (!last.bounded())
      result.warnings.push_back(last.name + " is open " + last.open() + ": this record does not bound it");
  }
  residualsOf(model, fit.internal);  // the law is that of the best fit again
  const double contact = result.find("contact")->value;
  result.depth = *std::max_element(curve.position.begin(), curve.position.end()) - contact;
  result.size = result.find("young_modulus")->value * law->force(result.depth, none).force;
  const Misfit misfit = misfitOf(curve, result.residuals, contact, whiteNoise(curve));
  result.misfit = misfit.found;
  result.scatter = misfit.expected;
  result.deviation = trimmedDeviation(result.residuals);
  for (const std::string& pair : inseparable(model, fit)) result.warnings.push_back(pair);
  if (config.rivals && !config.rivals->empty() && config.prony_terms == 0) {
    const double noise = std::max(whiteNoise(curve), 1e-3 * fit.noise);
    result.rivals = compared(model, fit, noise, config, drift);
  }
  if (result.depth > law->deepest()) {
    char text[160];
    std::snprintf(text, sizeof(text), "the record is %.3g um deep, the model %.3g um: below that it goes on straight",
                  1e6 * result.depth, 1e6 * law->deepest());
    result.warnings.emplace_back(text);
  }
  return result;
}

void leaveOutFirst(ForceCurve& curve, std::size_t count) {
  for (std::vector<double>* values : {&curve.time, &curve.position, &curve.force})
    values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(count));
}

/// By a first estimate. It takes means: a contact at the end of a very long way is lost in them, or known coarsely. It
/// is then looked for in the last half, the last quarter and so on. None: there is no contact.
std::optional<std::size_t> samplesInContact(const ForceCurve& curve) {
  for (const bool drift : {true, false}) {  // a drift alone may look like a contact
    std::optional<std::size_t> found;
    for (ForceCurve part = curve; part.size() > kFewestSearched; leaveOutFirst(part, part.size() / 2)) {
      const ContactGuess guess = guessContact(part, drift);
      if (!guess.touched) continue;
      found = static_cast<std::size_t>(
          std::count_if(part.position.begin(), part.position.end(), [&](double x) { return x > guess.contact; }));
      if (static_cast<double>(*found) > kKnown * static_cast<double>(part.size())) break;
    }
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace

std::string Estimate::open() const {
  if (bounded()) return "";
  return bounded_below ? "above" : bounded_above ? "below" : "on both sides";
}

bool Identification::consistent() const {
  if (rivals && rivals->contradicts()) return false;
  return misfit < kLeastMisfit * size || misfit < kSignificant * scatter;
}

const Estimate* Identification::find(const std::string& name) const {
  const auto found = std::find_if(estimates.begin(), estimates.end(), [&](const auto& x) { return x.name == name; });
  return found == estimates.end() ? nullptr : &*found;
}

const Estimate* Identification::undetermined() const {
  const auto found = std::find_if(estimates.begin(), estimates.end(), [](const Estimate& x) {
    const bool of_record = x.name == "offset" || x.name == "drift";
    return !of_record && !(x.bounded() && x.low < x.high && std::isfinite(x.high - x.low));
  });
  return found == estimates.end() ? nullptr : &*found;
}

ForceCurve identifiedCurve(const ForceCurve& record) {
  ForceCurve curve = withoutFrozenReadings(record);
  if (curve.size() <= kMostSamples) return curve;
  // A long approach must not cost the samples in contact: what is farthest from the cell goes first.
  const std::optional<std::size_t> inside = samplesInContact(curve);
  const std::size_t block = std::max<std::size_t>(1, inside.value_or(curve.size()) / kEnoughInContact);
  if (curve.size() <= block * kMostSamples) return averaged(curve, kMostSamples);
  const std::size_t far = curve.size() - block * kMostSamples;
  leaveOutFirst(curve, far);
  curve.notes.push_back("the " + std::to_string(far) + " samples farthest from the cell are left out");
  return averaged(curve, kMostSamples);
}

Identification identify(const ForceCurve& curve, const std::shared_ptr<ElasticLaw>& law,
                        const IdentificationConfig& config) {
  if (config.drift != Drift::kAuto) return identifyWith(curve, law, config, config.drift == Drift::kOn);
  IdentificationConfig quick = config;
  quick.intervals = false;
  quick.rivals = nullptr;
  // A force that rises from the first sample on may be a drift: then there is no contact to be sure of.
  const Identification drifting = identifyWith(curve, law, quick, true);
  const Estimate& drift = *drifting.find("drift");
  const double deviation = (drift.high - drift.low) / (2 * kDeviations95);
  const bool drifts = std::abs(drift.value) > 3 * deviation;
  return identifyWith(curve, law, config, drifts);
}

std::vector<double> informationCriteria(const std::vector<Identification>& models) {
  double count = 0;
  for (const Identification& model : models) count = std::max(count, model.independent);
  std::vector<double> result;
  for (const Identification& model : models) {
    result.push_back(2 * count * std::log(model.deviation) +
                     static_cast<double>(model.estimates.size()) * std::log(count));
  }
  return result;
}

}  // namespace microinjection
