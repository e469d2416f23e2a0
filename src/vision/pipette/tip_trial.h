#pragma once

#include <vector>

#include "vision/pipette/tip_model.h"

namespace microinjection {

/// In focus an end has a rim and no fringes, out of focus it has fringes. Incoherent light only blurs it.
enum class TipKind { kSharp, kFringed, kBlurred };

/// An end with the model that was tried, and the variance of the residuals.
struct TipTrial {
  double end = 0, rest = 1e30, rim = 0;  ///< rim: rows, 0 for none
  TipModel model;
  bool valid = false;
};

/// Degrees of freedom of the residuals.
double freedomOf(const TipWindow& window, const TipModel& model);

/// All models beside that of a trial, of its kind, at 11 ends about a place.
std::vector<TipTrial> trialsBeside(const TipWindow& window, const TipTrial& trial, TipKind kind, double about,
                                   double reach);

/// The best trial beside another one: one step in all of its numbers at a time.
TipTrial refined(const TipWindow& window, TipTrial trial, TipKind kind);

/// Trials of a kind on a grid within `reach` rows of a place.
std::vector<TipTrial> coarseTrials(const TipWindow& window, TipKind kind, double about, double reach);

/// The best trial of a kind, refined from several of the coarse ones.
TipTrial refinedBest(const TipWindow& window, TipKind kind, const std::vector<TipTrial>& coarse);

TipTrial bestOf(const std::vector<TipTrial>& all);

}  // namespace microinjection
