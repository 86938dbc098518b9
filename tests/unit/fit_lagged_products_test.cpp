#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "fit/lagged_products.hpp"

namespace {

using steerid::LaggedProducts;

double direct(const Eigen::VectorXd& y, const std::vector<double>& a, Eigen::Index first) {
  double sum = 0;
  for (Eigen::Index i = first; i < y.size(); ++i) {
    double error = y[i];
    for (std::size_t k = 0; k < a.size(); ++k) error += a[k] * y[i - 1 - static_cast<Eigen::Index>(k)];
    sum += error * error;
  }
  return sum;
}

TEST(LaggedProducts, GiveTheSquaresOfAnyPredictor) {
  const std::vector<Eigen::VectorXd> residuals = {Eigen::VectorXd::Random(60), Eigen::VectorXd::Random(45)};
  const std::vector<Eigen::VectorXd> absorbed = {Eigen::VectorXd::Random(60)};
  const LaggedProducts products(residuals, absorbed, 5);
  ASSERT_EQ(products.order(), 5);
  EXPECT_EQ(products.rows(), 55 + 40);
  for (const std::vector<double>& a : {std::vector<double>{}, {-0.9}, {0.3, -1.1, 0.2, 0.7, -0.4}}) {
    const double expected = direct(residuals[0], a, 5) + direct(residuals[1], a, 5) + direct(absorbed[0], a, 5);
    EXPECT_NEAR(products.squares(a), expected, 1e-12 * expected);
  }
}

TEST(LaggedProducts, RememberLessWhereSegmentsAreShort) {
  const std::vector<Eigen::VectorXd> residuals(10, Eigen::VectorXd::Random(30));
  const LaggedProducts products(residuals, {}, 100);
  EXPECT_EQ(products.order(), 15);
  EXPECT_EQ(products.rows(), 150);
}

}  // namespace
