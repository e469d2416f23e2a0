#include "cell/mechanics/equilibrium_system.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace microinjection {
namespace {

/// Change of the contact's tangent, relative, that refresh() takes notice of.
constexpr double kNoticeable = 0.01;

/// Component of the tip that a constrained entry follows.
int tipComponent(int unknown) { return -2 - unknown; }

/// Index of the pair (a, b) of an element's `size` entries, in either order, in a lower triangle
/// stored by columns.
int pairIndex(int a, int b, int size) {
  const int row = std::max(a, b), column = std::min(a, b);
  return column * size - column * (column - 1) / 2 + row - column;
}

int pairs(int size) { return size * (size + 1) / 2; }

}  // namespace

EquilibriumSystem::EquilibriumSystem(Terms terms, Constraints constraints, SymmetricSolver::Method method)
    : terms_(std::move(terms)), pressures_(constraints.pressures), solver_(method) {
  number(constraints);
  buildPattern();
  nonsmooth_ = std::make_unique<NonsmoothTangent>(terms_, unknown_, matrix_size_);
  solver_.analyse(matrix_, nonsmooth_->unknowns());
  coupling_.setZero(matrix_size_, 3);
  sensitivity_.setZero(free_size_, 3);
}

void EquilibriumSystem::number(const Constraints& constraints) {
  unknown_ = constraints.entries;
  std::vector<int*> internal;
  for (int& unknown : unknown_) {
    if (unknown == Constraints::kInternal) {
      internal.push_back(&unknown);
    } else if (unknown == Constraints::kFree) {
      unknown = matrix_size_++;
    }
  }
  free_size_ = matrix_size_;
  for (int* unknown : internal) *unknown = free_size_++;
  internal_.resize(internal.size());
  if (matrix_size_ == 0) throw std::invalid_argument("nothing is free to move");
}

/// Occurrence of an unknown among an element's entries.
struct EquilibriumSystem::Occurrence {
  const std::vector<int>* entries;
  int index;       ///< among the entries
  int first_slot;  ///< slot of the element's first pair
};

/// Occurrences of each unknown. Also allocates the slots.
std::vector<std::vector<EquilibriumSystem::Occurrence>> EquilibriumSystem::occurrences() {
  std::vector<std::vector<Occurrence>> result(matrix_size_);
  int next = 0;
  for (const auto& term : terms_) {
    for (int e = 0; e < term->elementCount(); ++e) {
      const std::vector<int>& entries = term->entries(e);
      const int size = static_cast<int>(entries.size());
      for (int a = 0; a < size; ++a) {
        const int unknown = unknown_[entries[a]];
        if (inMatrix(unknown)) result[unknown].push_back({&entries, a, next});
      }
      next += pairs(size);
    }
  }
  slots_.assign(next, -1);
  return result;
}

void EquilibriumSystem::buildPattern() {
  const std::vector<std::vector<Occurrence>> all = occurrences();
  std::vector<int> starts = {0}, rows;
  std::vector<int> position(matrix_size_, -1);  // of a row in the present column
  for (int column = 0; column < matrix_size_; ++column) {
    for (const Occurrence& occurrence : all[column]) {
      for (int entry : *occurrence.entries) {
        const int row = unknown_[entry];
        if (row < column || !inMatrix(row) || position[row] >= starts[column]) continue;
        position[row] = starts[column];
        rows.push_back(row);
      }
    }
    std::sort(rows.begin() + starts[column], rows.end());
    starts.push_back(static_cast<int>(rows.size()));
    for (int i = starts[column]; i < starts[column + 1]; ++i) position[rows[i]] = i;
    for (const Occurrence& occurrence : all[column]) {
      const int size = static_cast<int>(occurrence.entries->size());
      for (int a = 0; a < size; ++a) {
        const int row = unknown_[(*occurrence.entries)[a]];
        if (row >= column && inMatrix(row))
          slots_[occurrence.first_slot + pairIndex(a, occurrence.index, size)] = position[row];
      }
    }
  }
  const std::vector<double> zeros(rows.size(), 0);
  matrix_ = Eigen::Map<const Eigen::SparseMatrix<double>>(matrix_size_, matrix_size_, static_cast<int>(rows.size()),
                                                          starts.data(), rows.data(), zeros.data());
}

void EquilibriumSystem::addTo(Eigen::VectorXd& state, const Eigen::VectorXd& free,
                              const Eigen::Vector3d& translation) const {
  for (int i = 0; i < stateSize(); ++i) {
    const int unknown = unknown_[i];
    if (unknown >= 0) {
      state[i] += free[unknown];
    } else if (unknown != Constraints::kFixed) {
      state[i] += translation[tipComponent(unknown)];
    }
  }
}

bool EquilibriumSystem::energy(const Eigen::VectorXd& state, double& energy) {
  energy = 0;
  for (const auto& term : terms_) {
    for (int e = 0; e < term->elementCount(); ++e) {
      if (!term->evaluate(e, state, Order::kEnergy, local_)) return false;
      energy += local_.zero ? 0 : local_.energy;
    }
  }
  return true;
}

bool EquilibriumSystem::residual(const Eigen::VectorXd& state, Eigen::VectorXd& free, Eigen::Vector3d& reaction) {
  free.setZero(free_size_);
  reaction.setZero();
  for (const auto& term : terms_) {
    for (int e = 0; e < term->elementCount(); ++e) {
      if (!term->evaluate(e, state, Order::kGradient, local_)) return false;
      if (local_.zero) continue;
      const std::vector<int>& entries = term->entries(e);
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const int unknown = unknown_[entries[i]];
        if (unknown >= 0) {
          free[unknown] += local_.gradient[i];
        } else if (unknown != Constraints::kFixed) {
          reaction[tipComponent(unknown)] += local_.gradient[i];
        }
      }
    }
  }
  return free.allFinite() && reaction.allFinite();
}

/// Adds the stiffness of a constrained entry to K_ft and K_tt.
void EquilibriumSystem::addConstrained(int row, int column, double value, bool diagonal) {
  const auto without = [&](int unknown) { return unknown == Constraints::kFixed || unknown >= matrix_size_; };
  if (without(row) || without(column)) return;
  if (row >= 0) {
    coupling_(row, tipComponent(column)) += value;
  } else if (column >= 0) {
    coupling_(column, tipComponent(row)) += value;
  } else {
    tip_stiffness_(tipComponent(row), tipComponent(column)) += value;
    if (!diagonal) tip_stiffness_(tipComponent(column), tipComponent(row)) += value;
  }
}

void EquilibriumSystem::scatter(const std::vector<int>& entries, const Eigen::MatrixXd& hessian, const int* slot) {
  double* values = matrix_.valuePtr();
  const int size = static_cast<int>(entries.size());
  for (int b = 0; b < size; ++b) {
    const double* column = hessian.data() + b * size;
    for (int a = b; a < size; ++a, ++slot) {
      if (*slot >= 0) {
        values[*slot] += column[a];
      } else {
        addConstrained(unknown_[entries[a]], unknown_[entries[b]], column[a], a == b);
      }
    }
  }
}

bool EquilibriumSystem::assemble(const Eigen::VectorXd& state) {
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  coupling_.setZero();
  tip_stiffness_.setZero();
  const int* slot = slots_.data();
  for (const auto& term : terms_) {
    for (int e = 0; e < term->elementCount(); ++e) {
      const std::vector<int>& entries = term->entries(e);
      if (!term->evaluate(e, state, Order::kHessian, local_)) return false;
      if (!local_.zero) {
        if (unknown_[entries.back()] >= matrix_size_) eliminate(entries, local_.hessian);
        scatter(entries, local_.hessian, slot);
      }
      slot += pairs(static_cast<int>(entries.size()));
    }
  }
  return true;
}

bool EquilibriumSystem::settleInternal(Eigen::VectorXd& state) {
  if (internal_.empty()) return true;
  for (const auto& term : terms_) {
    for (int e = 0; e < term->elementCount(); ++e) {
      const int entry = term->entries(e).back(), unknown = unknown_[entry];
      if (unknown < matrix_size_) continue;
      if (!term->evaluate(e, state, Order::kGradient, local_)) return false;
      if (!local_.zero)
        state[entry] -= local_.gradient[local_.gradient.size() - 1] / internal_[unknown - matrix_size_].pivot;
    }
  }
  return true;
}

/// Static condensation of an element's last entry.
void EquilibriumSystem::eliminate(const std::vector<int>& entries, Eigen::MatrixXd& hessian) {
  Internal& internal = internal_[unknown_[entries.back()] - matrix_size_];
  const Eigen::Index others = hessian.rows() - 1;
  internal.entries = &entries;
  internal.row = hessian.row(others).head(others);
  internal.pivot = hessian(others, others);
  hessian.topLeftCorner(others, others).noalias() -= (internal.row / internal.pivot) * internal.row.transpose();
}

Eigen::VectorXd EquilibriumSystem::solve(const Eigen::VectorXd& right_hand_side) {
  Eigen::VectorXd right = right_hand_side.head(matrix_size_), result(free_size_);
  const auto eachFree = [&](const Internal& internal, auto&& visit) {
    for (Eigen::Index a = 0; a < internal.row.size(); ++a) {
      const int unknown = unknown_[(*internal.entries)[a]];
      if (unknown >= 0) visit(unknown, internal.row[a]);
    }
  };
  for (std::size_t i = 0; i < internal_.size(); ++i) {
    const double share = right_hand_side[matrix_size_ + i] / internal_[i].pivot;
    eachFree(internal_[i], [&](int unknown, double value) { right[unknown] -= share * value; });
  }
  result.head(matrix_size_) = solver_.solve(right);
  for (std::size_t i = 0; i < internal_.size(); ++i) {
    double rest = right_hand_side[matrix_size_ + i];
    eachFree(internal_[i], [&](int unknown, double value) { rest -= value * result[unknown]; });
    result[matrix_size_ + i] = rest / internal_[i].pivot;
  }
  return result;
}

/// Computes the sensitivity of all free entries to the tip's translation.
void EquilibriumSystem::condenseTip() {
  sensitivity_.topRows(matrix_size_) = -solver_.solve(coupling_);
  for (std::size_t i = 0; i < internal_.size(); ++i) {
    Eigen::RowVector3d change = Eigen::RowVector3d::Zero();
    for (Eigen::Index a = 0; a < internal_[i].row.size(); ++a) {
      const int unknown = unknown_[(*internal_[i].entries)[a]];
      if (unknown >= 0) {
        change += internal_[i].row[a] * sensitivity_.row(unknown);
      } else if (unknown != Constraints::kFixed) {
        change[tipComponent(unknown)] += internal_[i].row[a];
      }
    }
    sensitivity_.row(matrix_size_ + i) = -change / internal_[i].pivot;
  }
  stiffness_ = tip_stiffness_ + coupling_.transpose() * sensitivity_.topRows(matrix_size_);
}

bool EquilibriumSystem::refresh(const Eigen::VectorXd& state) {
  if (factorised_contact_.size() == 0) return false;
  Eigen::MatrixXd tangent;
  if (!nonsmooth_->evaluate(state, tangent)) return false;
  if (!((tangent - present_contact_).norm() > kNoticeable * tangent.norm())) return false;
  present_contact_ = tangent;
  return solver_.update(tangent - factorised_contact_);
}

bool EquilibriumSystem::factorise(const Eigen::VectorXd& state) {
  if (!assemble(state) || !solver_.factorise(matrix_, pressures_)) return false;
  if (!nonsmooth_->evaluate(state, factorised_contact_)) factorised_contact_.resize(0, 0);
  present_contact_ = factorised_contact_;
  condenseTip();
  stiffness_ = 0.5 * (stiffness_ + stiffness_.transpose()).eval();
  return stiffness_.allFinite();
}

}  // namespace microinjection
