// LDLᵀ of a sparse symmetric matrix of 6 × 6 blocks, one row of blocks a body, in an order of least
// degree.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "tools/bench/baselines/solvers/vectors.h"

namespace lockstone::bench::trial {

class BlockFactor {
 public:
  // Finds the order and the fill for these pairs of bodies; nothing is done if they are as before.
  void analyse(int bodies, std::vector<std::pair<int, int>> pairs);
  void set_identity();
  // Adds k (ja, jb)ᵀ (ja, jb); a body of −1 is fixed.
  void add_row(int a, int b, const Vec6& ja, const Vec6& jb, double k);
  // `bits` of mantissa are kept of every entry; 0: all.
  void factor(int bits);
  void solve(std::vector<Vec6>& x) const;

  [[nodiscard]] int blocks() const { return static_cast<int>(values_.size()); }
  [[nodiscard]] double least_pivot() const { return least_pivot_; }
  [[nodiscard]] double greatest_pivot() const { return greatest_pivot_; }

 private:
  struct Below {
    int row = 0;
    int block = 0;
  };
  void order(std::vector<std::vector<int>>& neighbours);
  void eliminate(std::vector<std::vector<int>>& neighbours, int body);
  int& block_at(int row, int column) { return table_[row * bodies_ + column]; }
  void add_outer(int block, const Vec6& row, const Vec6& column, double k);
  void factor_diagonal(Mat6& d, int bits);
  void factor_column(int column, int bits);

  int bodies_ = 0;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<int> place_;                 // of a body in the order
  std::vector<int> table_;                 // block of a row and column in the order, −1: none
  std::vector<std::vector<Below>> below_;  // of a column: blocks under its diagonal
  std::vector<Mat6> values_;
  double least_pivot_ = 1e300, greatest_pivot_ = 0;
};

}  // namespace lockstone::bench::trial
