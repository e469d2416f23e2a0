#include "mechanics/patch_system.h"

#include <algorithm>
#include <stdexcept>

namespace microinjection {

PatchSystem::PatchSystem(const ElasticBody& body, const std::vector<int>& held, const std::vector<int>& patch)
    : body_(body) {
  numberUnknowns(held, patch);
  buildPattern();
  cholesky_.analyse(matrix_);
  coupling_.resize(free_size_, 3);
  sensitivity_.setZero(free_size_, 3);
}

void PatchSystem::numberUnknowns(const std::vector<int>& held, const std::vector<int>& patch) {
  constexpr int kFree = 0, kPatch = 1;
  unknown_.assign(body_.vertexCount(), kFree);
  for (int vertex : held) unknown_[vertex] = -1;
  for (int vertex : patch) {
    if (unknown_[vertex] < 0) throw std::invalid_argument("the tip's patch and the held vertices overlap");
    unknown_[vertex] = kPatch;
  }
  const int free_vertices = static_cast<int>(std::count(unknown_.begin(), unknown_.end(), kFree));
  if (free_vertices == 0) throw std::invalid_argument("no vertex is free");
  int next = 0;
  for (int& unknown : unknown_) {
    if (unknown == kFree) {
      unknown = next;
      next += 3;
    } else if (unknown == kPatch) {
      unknown = 3 * free_vertices;
    }
  }
  free_size_ = next;
}

void PatchSystem::buildPattern() {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(144u * body_.elementCount());
  for (int e = 0; e < body_.elementCount(); ++e) {
    for (int row_vertex : body_.corners(e)) {
      for (int column_vertex : body_.corners(e)) {
        const int row = unknown_[row_vertex], column = unknown_[column_vertex];
        if (row < column || column < 0 || row >= free_size_) continue;
        for (int j = 0; j < 3; ++j) {
          for (int i = row == column ? j : 0; i < 3; ++i) entries.emplace_back(row + i, column + j, 0);
        }
      }
    }
  }
  matrix_.resize(free_size_, free_size_);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  matrix_.makeCompressed();

  // Rows of a 3 x 3 block are consecutive in each column: remember where each column of each block begins.
  for (int e = 0; e < body_.elementCount(); ++e) {
    for (int row_vertex : body_.corners(e)) {
      for (int column_vertex : body_.corners(e)) {
        const int row = unknown_[row_vertex], column = unknown_[column_vertex];
        if (row < column || column < 0 || row >= free_size_) continue;
        for (int j = 0; j < 3; ++j) {
          const int first = row + (row == column ? j : 0);
          const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + j];
          const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[column + j + 1];
          slots_.push_back(static_cast<int>(std::lower_bound(begin, end, first) - matrix_.innerIndexPtr()));
        }
      }
    }
  }
}

void PatchSystem::addTo(Eigen::VectorXd& u, const Eigen::VectorXd& free, const Eigen::Vector3d& translation) const {
  for (int v = 0; v < body_.vertexCount(); ++v) {
    if (unknown_[v] == free_size_) {
      u.segment<3>(3 * v) += translation;
    } else if (unknown_[v] >= 0) {
      u.segment<3>(3 * v) += free.segment<3>(unknown_[v]);
    }
  }
}

void PatchSystem::residual(const Eigen::VectorXd& u, Eigen::VectorXd& free, Eigen::Vector3d& reaction) {
  body_.internalForce(u, force_);
  free.resize(free_size_);
  reaction.setZero();
  for (int v = 0; v < body_.vertexCount(); ++v) {
    if (unknown_[v] == free_size_) {
      reaction += force_.segment<3>(3 * v);
    } else if (unknown_[v] >= 0) {
      free.segment<3>(unknown_[v]) = force_.segment<3>(3 * v);
    }
  }
}

void PatchSystem::scatter(int element, const ElasticBody::ElementMatrix& stiffness, const int*& slot) {
  const std::array<int, 4>& corners = body_.corners(element);
  double* values = matrix_.valuePtr();
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const int row = unknown_[corners[a]], column = unknown_[corners[b]];
      if (row < 0 || column < 0) continue;
      const auto block = stiffness.block<3, 3>(3 * a, 3 * b);
      if (column == free_size_) {
        if (row == free_size_) {
          patch_stiffness_ += block;
        } else {
          coupling_.middleRows<3>(row) += block;
        }
      } else if (row < free_size_ && row >= column) {
        for (int j = 0; j < 3; ++j) {
          double* value = values + *slot++;
          for (int i = row == column ? j : 0; i < 3; ++i) *value++ += block(i, j);
        }
      }
    }
  }
}

void PatchSystem::assemble(const Eigen::VectorXd& u) {
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  coupling_.setZero();
  patch_stiffness_.setZero();
  const int* slot = slots_.data();
  ElasticBody::ElementMatrix stiffness;
  for (int e = 0; e < body_.elementCount(); ++e) {
    body_.elementStiffness(e, u, stiffness);
    scatter(e, stiffness, slot);
  }
}

bool PatchSystem::factorise(const Eigen::VectorXd& u) {
  assemble(u);
  if (!cholesky_.factorise(matrix_)) return false;
  sensitivity_ = -cholesky_.solve(coupling_);
  const Eigen::Matrix3d condensed = patch_stiffness_ + coupling_.transpose() * sensitivity_;
  stiffness_ = 0.5 * (condensed + condensed.transpose());  // symmetric to rounding: make it exact
  return true;
}

}  // namespace microinjection
