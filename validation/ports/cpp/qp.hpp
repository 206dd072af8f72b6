// The quadratic program, by a dual active-set method in numbers of 400 bits.
#pragma once
#include <gmpxx.h>

#include <stdexcept>
#include <vector>

using Number = mpf_class;
using Numbers = std::vector<Number>;
using Matrix = std::vector<Numbers>;

const Number tiny(1e-60);

inline Number inner(const Numbers& a, const Numbers& b) {
  Number sum = 0;
  for (size_t i = 0; i < a.size(); i++) sum += a[i] * b[i];
  return sum;
}

// x with M x = y, by Gauss.
inline Numbers solved(Matrix M, Numbers y) {
  int n = y.size();
  for (int k = 0; k < n; k++) {
    int pivot = k;
    for (int i = k + 1; i < n; i++)
      if (abs(M[i][k]) > abs(M[pivot][k])) pivot = i;
    std::swap(M[k], M[pivot]);
    std::swap(y[k], y[pivot]);
    for (int i = k + 1; i < n; i++) {
      Number factor = M[i][k] / M[k][k];
      if (factor == 0) continue;
      for (int j = k; j < n; j++) M[i][j] -= factor * M[k][j];
      y[i] -= factor * y[k];
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    for (int j = k + 1; j < n; j++) y[k] -= M[k][j] * y[j];
    y[k] /= M[k][k];
  }
  return y;
}

struct Infeasible {
  std::vector<double> farkas;
};

// lam >= 0 with S lam >= d and lam'(S lam - d) = 0.
inline Numbers multipliers(const Matrix& S, const Numbers& d) {
  int m = d.size();
  Numbers lam(m);
  std::vector<int> active;
  Number size = 0;
  for (const Number& x : d)
    if (abs(x) > size) size = abs(x);
  while (true) {
    int p = -1;
    Number lack = tiny * size;
    for (int i = 0; i < m; i++) {
      Number short_of = d[i] - inner(S[i], lam);
      if (short_of > lack) {
        lack = short_of;
        p = i;
      }
    }
    if (p < 0) return lam;
    while (lack > 0) {
      // Raising lam_p by 1 lowers those of the active rows by r, which stay without slack.
      Matrix M;
      Numbers y;
      for (int i : active) {
        M.emplace_back();
        for (int j : active) M.back().push_back(S[i][j]);
        y.push_back(S[i][p]);
      }
      Numbers r = solved(M, y);
      for (Number& x : r)
        if (abs(x) < tiny) x = 0;
      Number gain = S[p][p] - inner(y, r);
      int drop = -1;
      Number step = -1;
      bool dependent = gain <= tiny * S[p][p];
      if (!dependent) step = lack / gain;
      for (size_t a = 0; a < active.size(); a++) {
        if (r[a] <= 0) continue;
        Number until = lam[active[a]] / r[a];
        if (step < 0 || until < step) {
          step = until;
          drop = a;
        }
      }
      if (step < 0) {
        std::vector<double> farkas(m, 0.);
        Number largest = 1;
        for (const Number& x : r)
          if (-x > largest) largest = -x;
        for (size_t a = 0; a < active.size(); a++) farkas[active[a]] = Number(-r[a] / largest).get_d();
        farkas[p] = Number(1 / largest).get_d();
        throw Infeasible{farkas};
      }
      for (size_t a = 0; a < active.size(); a++) lam[active[a]] -= step * r[a];
      lam[p] += step;
      lack -= step * gain;
      if (drop >= 0) {
        lam[active[drop]] = 0;
        active.erase(active.begin() + drop);
      } else {
        active.push_back(p);
        lack = 0;
      }
    }
  }
}

// The data as they are written, and what follows from them without rounding to float64.
struct Program {
  Matrix H, A, S;  // S = A H^-1 A'
  Numbers g, b, d;  // d = b - A H^-1 g
  Numbers lam, x, impulse, slack;

  Program(const std::vector<std::vector<double>>& H_, const std::vector<double>& g_, const std::vector<std::vector<double>>& A_,
          const std::vector<double>& b_) {
    for (auto& row : H_) H.emplace_back(row.begin(), row.end());
    for (auto& row : A_) A.emplace_back(row.begin(), row.end());
    g.assign(g_.begin(), g_.end());
    b.assign(b_.begin(), b_.end());
    Numbers free = solved(H, g);
    for (size_t i = 0; i < A.size(); i++) {
      Numbers moved = solved(H, A[i]);
      S.emplace_back();
      for (const Numbers& row : A) S.back().push_back(inner(moved, row));
      d.push_back(b[i] - inner(A[i], free));
    }
  }

  void solve() {
    lam = multipliers(S, d);
    impulse.assign(g.size(), 0);
    for (size_t i = 0; i < A.size(); i++)
      for (size_t j = 0; j < g.size(); j++) impulse[j] += A[i][j] * lam[i];
    Numbers total = g;
    for (size_t j = 0; j < g.size(); j++) total[j] += impulse[j];
    x = solved(H, total);
    for (size_t i = 0; i < A.size(); i++) slack.push_back(inner(A[i], x) - b[i]);
  }
};

inline std::vector<double> doubles(const Numbers& x) {
  std::vector<double> found;
  for (const Number& value : x) found.push_back(value.get_d());
  return found;
}
