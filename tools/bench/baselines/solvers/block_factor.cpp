#include "tools/bench/baselines/solvers/block_factor.h"

#include <algorithm>
#include <cmath>

namespace lockstone::bench::trial {
namespace {

double shortened(double x, int bits) {
  if (bits == 0 || x == 0) return x;
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, bits)), exponent - bits);
}

// x ← (L D Lᵀ)⁻¹ x for a block whose factors stand in its lower half and diagonal.
void solve_block(const Mat6& d, double* x, int stride) {
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < i; ++k)
      x[i * stride] -= d[i * 6 + k] * x[k * stride];
  for (int i = 0; i < 6; ++i)
    x[i * stride] /= d[i * 6 + i];
  for (int i = 5; i >= 0; --i)
    for (int k = i + 1; k < 6; ++k)
      x[i * stride] -= d[k * 6 + i] * x[k * stride];
}

// c −= a bᵀ
void subtract_product(Mat6& c, const Mat6& a, const Mat6& b) {
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) {
      double sum = 0;
      for (int m = 0; m < 6; ++m)
        sum += a[i * 6 + m] * b[k * 6 + m];
      c[i * 6 + k] -= sum;
    }
}

}  // namespace

void BlockFactor::analyse(int bodies, std::vector<std::pair<int, int>> pairs) {
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  if (bodies == bodies_ && pairs == pairs_) return;
  bodies_ = bodies;
  pairs_ = std::move(pairs);
  std::vector<std::vector<int>> neighbours(bodies);
  for (const auto& [a, b] : pairs_) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  place_.assign(bodies, -1);
  table_.assign(static_cast<std::size_t>(bodies) * bodies, -1);
  below_.assign(bodies, {});
  values_.assign(bodies, {});
  order(neighbours);
}

// Fill is found on the way: the remaining neighbours of an eliminated body become a clique.
void BlockFactor::order(std::vector<std::vector<int>>& neighbours) {
  std::vector<int> sequence;
  for (int step = 0; step < bodies_; ++step) {
    int best = -1;
    for (int body = 0; body < bodies_; ++body)
      if (place_[body] < 0 && (best < 0 || neighbours[body].size() < neighbours[best].size()))
        best = body;
    place_[best] = step;
    sequence.push_back(best);
    eliminate(neighbours, best);
  }
  int block = bodies_;
  for (int column = 0; column < bodies_; ++column) {
    block_at(column, column) = column;
    for (const int body : neighbours[sequence[column]]) {
      below_[column].push_back({place_[body], block});
      block_at(place_[body], column) = block++;
    }
  }
  values_.resize(block);
}

void BlockFactor::eliminate(std::vector<std::vector<int>>& neighbours, int body) {
  const std::vector<int>& around = neighbours[body];
  for (const int n : around) {
    std::vector<int> merged = around;
    merged.insert(merged.end(), neighbours[n].begin(), neighbours[n].end());
    std::ranges::sort(merged);
    merged.erase(std::unique(merged.begin(), merged.end()), merged.end());
    std::erase(merged, n);
    std::erase(merged, body);
    neighbours[n] = std::move(merged);
  }
}

void BlockFactor::set_identity() {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    values_[i].fill(0);
    if (static_cast<int>(i) >= bodies_) continue;
    for (int k = 0; k < 6; ++k)
      values_[i][k * 7] = 1;
  }
}

void BlockFactor::add_outer(int block, const Vec6& row, const Vec6& column, double k) {
  Mat6& m = values_[block];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      m[i * 6 + j] += k * row[i] * column[j];
}

void BlockFactor::add_row(int a, int b, const Vec6& ja, const Vec6& jb, double k) {
  if (a >= 0) add_outer(place_[a], ja, ja, k);
  if (b >= 0) add_outer(place_[b], jb, jb, k);
  if (a < 0 || b < 0) return;
  const int pa = place_[a], pb = place_[b];
  if (pa > pb) add_outer(block_at(pa, pb), ja, jb, k);
  if (pa < pb) add_outer(block_at(pb, pa), jb, ja, k);
}

void BlockFactor::factor_diagonal(Mat6& d, int bits) {
  for (int j = 0; j < 6; ++j) {
    for (int k = 0; k < j; ++k)
      d[j * 7] -= d[j * 6 + k] * d[j * 6 + k] * d[k * 7];
    d[j * 7] = shortened(std::max(d[j * 7], 0.5), bits);
    least_pivot_ = std::min(least_pivot_, d[j * 7]);
    greatest_pivot_ = std::max(greatest_pivot_, d[j * 7]);
    for (int i = j + 1; i < 6; ++i) {
      for (int k = 0; k < j; ++k)
        d[i * 6 + j] -= d[i * 6 + k] * d[j * 6 + k] * d[k * 7];
      d[i * 6 + j] = shortened(d[i * 6 + j] / d[j * 7], bits);
    }
  }
}

void BlockFactor::factor_column(int column, int bits) {
  factor_diagonal(values_[column], bits);
  const std::vector<Below>& below = below_[column];
  std::vector<Mat6> raw;
  for (const Below& b : below) {
    Mat6& l = values_[b.block];
    raw.push_back(l);
    for (int i = 0; i < 6; ++i)
      solve_block(values_[column], &l[i * 6], 1);
    if (bits == 0) continue;
    for (double& x : l)
      x = shortened(x, bits);
  }
  for (std::size_t i = 0; i < below.size(); ++i)
    for (std::size_t k = 0; k < below.size(); ++k) {
      if (below[k].row > below[i].row) continue;
      const int target = block_at(below[i].row, below[k].row);
      subtract_product(values_[target], values_[below[i].block], raw[k]);
    }
}

void BlockFactor::factor(int bits) {
  for (int column = 0; column < bodies_; ++column)
    factor_column(column, bits);
}

void BlockFactor::solve(std::vector<Vec6>& x) const {
  std::vector<Vec6> y(bodies_);
  for (int i = 0; i < bodies_; ++i)
    y[place_[i]] = x[i];
  for (int c = 0; c < bodies_; ++c)
    for (const Below& b : below_[c])
      for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 6; ++k)
          y[b.row][i] -= values_[b.block][i * 6 + k] * y[c][k];
  for (int c = bodies_ - 1; c >= 0; --c) {
    solve_block(values_[c], y[c].data(), 1);
    for (const Below& b : below_[c])
      for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 6; ++k)
          y[c][k] -= values_[b.block][i * 6 + k] * y[b.row][i];
  }
  for (int i = 0; i < bodies_; ++i)
    x[i] = y[place_[i]];
}

}  // namespace lockstone::bench::trial
