#include "cell/mechanics/symmetric_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <utility>
#include <vector>

#include "cell/mechanics/bodies.h"

namespace microinjection {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Method = SymmetricSolver::Method;

constexpr Method kMethods[] = {Method::kSimplicial, Method::kSupernodal, Method::kIndefinite};

Matrix lowerTriangle(const Eigen::MatrixXd& dense) {
  return Matrix(Eigen::MatrixXd(dense.triangularView<Eigen::Lower>()).sparseView());
}

/// Chain of n springs, both ends held, shifted: its eigenvalues are 2 - 2 cos(k pi / (n + 1)) - shift, k = 1 ... n.
Eigen::MatrixXd chain(int n, double shift = 0) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  K.diagonal().setConstant(2 - shift);
  K.diagonal(1).setConstant(-1);
  K.diagonal(-1).setConstant(-1);
  return K;
}

int negatives(const Eigen::MatrixXd& K) {
  return static_cast<int>((Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().array() < 0).count());
}

TEST(SymmetricSolver, SolvesOneAndSeveralRightHandSides) {
  const Eigen::MatrixXd K = chain(50);
  const Eigen::MatrixXd right = randomVector(150, 1).reshaped(50, 3);
  for (const Method method : kMethods) {
    SymmetricSolver solver(method);
    solver.analyse(lowerTriangle(K));
    ASSERT_TRUE(solver.factorise(lowerTriangle(K)));
    EXPECT_LT((K * solver.solve(right) - right).norm(), 1e-12);
    EXPECT_LT((solver.solve(right.col(1)) - solver.solve(right).col(1)).norm(), 1e-12);
    EXPECT_GE(solver.factorEntries(), 99);
  }
}

/// The last unknowns' block of K gets another value: the solver must give the solution of the changed matrix.
TEST(SymmetricSolver, UpdatesTheBlockOfTheLastUnknowns) {
  constexpr int kSize = 200;
  Eigen::MatrixXd K = chain(kSize) + 0.1 * Eigen::MatrixXd::Identity(kSize, kSize);
  const std::vector<int> last = {17, 3, 150, 80, 81};
  for (const int a : last) {  // they are coupled by the matrix, too
    for (const int b : last) K(a, b) += a == b ? 5 : -1;
  }
  SymmetricSolver solver(Method::kSupernodal);
  solver.analyse(lowerTriangle(K), last);
  ASSERT_TRUE(solver.factorise(lowerTriangle(K)));
  const Eigen::MatrixXd right = randomVector(2 * kSize, 1).reshaped(kSize, 2);
  EXPECT_LT((K * solver.solve(right) - right).norm(), 1e-11);
  for (const double factor : {100.0, 3.0}) {  // the second change replaces the first
    const Eigen::MatrixXd root = randomVector(25, factor).reshaped(5, 5);
    const Eigen::MatrixXd change = root * root.transpose() - Eigen::MatrixXd::Identity(5, 5);
    ASSERT_TRUE(solver.update(change));
    Eigen::MatrixXd changed = K;
    for (int a = 0; a < 5; ++a) {
      for (int b = 0; b < 5; ++b) changed(last[a], last[b]) += change(a, b);
    }
    EXPECT_LT((changed * solver.solve(right) - right).norm(), 1e-9);
  }
  EXPECT_FALSE(solver.update(-100 * Eigen::MatrixXd::Identity(5, 5)));  // not positive definite
  ASSERT_TRUE(solver.factorise(lowerTriangle(K)));
  EXPECT_LT((K * solver.solve(right) - right).norm(), 1e-11);
}

TEST(SymmetricSolver, UpdatesNothingWithoutLastUnknownsOrWithoutSupernodes) {
  const Eigen::MatrixXd K = chain(50);
  const Eigen::MatrixXd change = Eigen::MatrixXd::Identity(2, 2);
  for (const Method method : kMethods) {
    SymmetricSolver solver(method);
    solver.analyse(lowerTriangle(K), method == Method::kSupernodal ? std::vector<int>() : std::vector<int>{1, 7});
    ASSERT_TRUE(solver.factorise(lowerTriangle(K)));
    EXPECT_FALSE(solver.update(change));
    EXPECT_LT((K * solver.solve(K) - K).norm(), 1e-11);
  }
}

TEST(SymmetricSolver, OnlyThePositiveDefiniteHaveACholeskyFactorAndItRecovers) {
  const Eigen::MatrixXd good = chain(50), bad = chain(50, 0.1);
  ASSERT_GT(negatives(bad), 0);
  for (const Method method : kMethods) {
    SymmetricSolver solver(method);
    solver.analyse(lowerTriangle(good));
    EXPECT_FALSE(solver.factorise(lowerTriangle(bad)));
    ASSERT_TRUE(solver.factorise(lowerTriangle(good)));
    const Eigen::VectorXd right = Eigen::VectorXd::Ones(50);
    EXPECT_LT((good * solver.solve(right) - right).norm(), 1e-12);
  }
}

TEST(SymmetricSolver, SingularIsRefused) {
  Eigen::MatrixXd K = chain(50);
  K.row(20).setZero();
  K.col(20).setZero();
  for (const Method method : kMethods) {
    SymmetricSolver solver(method);
    solver.analyse(lowerTriangle(chain(50)));
    Matrix lower = lowerTriangle(chain(50));
    for (int j = 0; j < 50; ++j) {
      for (Matrix::InnerIterator entry(lower, j); entry; ++entry) entry.valueRef() = K(entry.row(), j);
    }
    EXPECT_FALSE(solver.factorise(lower));
  }
}

TEST(SymmetricSolver, InertiaMustBeTheOneExpected) {
  const double pi = 3.14159265358979323846;
  for (const int expected : {1, 7, 31}) {
    const double shift = 2 - 2 * std::cos((expected + 0.37) * pi / 51);  // between two eigenvalues
    const Eigen::MatrixXd K = chain(50, shift);
    ASSERT_EQ(negatives(K), expected);
    SymmetricSolver solver(Method::kIndefinite);
    solver.analyse(lowerTriangle(K));
    EXPECT_FALSE(solver.factorise(lowerTriangle(K), expected - 1));
    EXPECT_FALSE(solver.factorise(lowerTriangle(K), expected + 1));
    EXPECT_FALSE(solver.factorise(lowerTriangle(K)));
    ASSERT_TRUE(solver.factorise(lowerTriangle(K), expected));
    const Eigen::VectorXd right = randomVector(50, 1);
    EXPECT_LT((K * solver.solve(right) - right).norm(), 1e-10);
  }
}

/// Saddle point: n displacements, m pressures, [K B; B^T -C] has m negative eigenvalues.
TEST(SymmetricSolver, PressuresMakeAsManyNegativeEigenvalues) {
  const int n = 40, m = 15;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, n + m);
  K.topLeftCorner(n, n) = chain(n);
  K.bottomLeftCorner(m, n) = randomVector(n * m, 1).reshaped(m, n);
  K.topRightCorner(n, m) = K.bottomLeftCorner(m, n).transpose();
  K.bottomRightCorner(m, m) = -1e-3 * Eigen::MatrixXd::Identity(m, m);
  SymmetricSolver solver(Method::kIndefinite);
  solver.analyse(lowerTriangle(K));
  ASSERT_TRUE(solver.factorise(lowerTriangle(K), m));
  const Eigen::VectorXd right = randomVector(n + m, 1);
  EXPECT_LT((K * solver.solve(right) - right).norm(), 1e-9);
  K.topLeftCorner(n, n) = chain(n, 2);  // as of a body that is not stable
  EXPECT_FALSE(solver.factorise(lowerTriangle(K), m));
}

}  // namespace
}  // namespace microinjection
