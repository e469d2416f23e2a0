#pragma once

#include <string>

#include "cell/identification/identification.h"

namespace microinjection {

/// Prints what was found by `model` on the standard output.
void printIdentification(const std::string& model, const Identification& found);

/// Rows of the CSV of --csv, below this line.
constexpr char kEstimateColumns[] = "model,quantity,value,low,high,unit,bounded\n";
std::string estimateRows(const std::string& model, const Identification& found);

/// CSV of --residuals.
std::string residualTable(const ForceCurve& curve, const Identification& found);

}  // namespace microinjection
