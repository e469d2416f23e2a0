#include "cell/mechanics/nonsmooth_tangent.h"

namespace microinjection {

NonsmoothTangent::NonsmoothTangent(const std::vector<std::shared_ptr<EnergyTerm>>& terms,
                                   const std::vector<int>& unknown, int size)
    : rows_(unknown.size(), -1) {
  for (const auto& term : terms) {
    bool any = false;
    for (int e = 0; e < term->elementCount(); ++e) {
      if (!term->isNonsmooth(e)) continue;
      any = true;
      for (const int entry : term->entries(e)) {
        if (unknown[entry] < 0 || unknown[entry] >= size || rows_[entry] >= 0) continue;
        rows_[entry] = static_cast<int>(unknowns_.size());
        unknowns_.push_back(unknown[entry]);
      }
    }
    if (any) terms_.push_back(term);
  }
}

bool NonsmoothTangent::evaluate(const Eigen::VectorXd& state, Eigen::MatrixXd& tangent) {
  const auto size = static_cast<Eigen::Index>(unknowns_.size());
  tangent.setZero(size, size);
  for (const auto& term : terms_) {
    for (int e = 0; e < term->elementCount(); ++e) {
      const bool mine = term->isNonsmooth(e);
      if (!term->evaluate(e, state, mine ? Order::kHessian : Order::kEnergy, local_)) return false;
      if (local_.zero) continue;
      if (!mine) return false;
      const std::vector<int>& entries = term->entries(e);
      for (std::size_t b = 0; b < entries.size(); ++b) {
        const int column = rows_[entries[b]];
        for (std::size_t a = 0; column >= 0 && a < entries.size(); ++a) {
          const int row = rows_[entries[a]];
          if (row >= 0) tangent(row, column) += local_.hessian(static_cast<int>(a), static_cast<int>(b));
        }
      }
    }
  }
  return true;
}

}  // namespace microinjection
