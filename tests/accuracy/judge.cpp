#include <algorithm>
#include <cmath>
#include <cstdio>

#include "accuracy/case.h"

namespace tendril::accuracy {
namespace {

std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

const Row* row_at(const Quantity& quantity, int n) {
  for (const Row& row : quantity.rows)
    if (row.n == n) return &row;
  return nullptr;
}

/// Smallest and largest order of the rows it is asked for.
struct Orders {
  double least = HUGE_VAL, most = -HUGE_VAL;
  bool finite = true;
  const Row* last = nullptr;
  std::string words() const {
    const std::string low = number("%.2f", least), high = number("%.2f", most);
    return low == high ? low : low + " to " + high;
  }
};
Orders orders_of(const Quantity& quantity, const Order& asked) {
  Orders out;
  for (std::size_t i = 1; i < quantity.rows.size(); ++i) {
    if (quantity.rows[i].n < asked.from) continue;
    const double order = order_between(quantity.rows[i - 1], quantity.rows[i]);
    out.finite = out.finite && std::isfinite(order);
    out.least = std::min(out.least, order);
    out.most = std::max(out.most, order);
    out.last = &quantity.rows[i];
  }
  return out;
}

}  // namespace

double order_between(const Row& coarse, const Row& fine) {
  return std::log(std::abs(coarse.error / fine.error)) / std::log(static_cast<double>(fine.n) / coarse.n);
}

std::vector<Verdict> judge(const Quantity& quantity) {
  std::vector<Verdict> out;
  for (const Limit& limit : quantity.limits) {
    const Row* row = row_at(quantity, limit.n);
    const bool holds = row && std::abs(row->error) <= limit.error;
    out.push_back({quantity.name, row ? *row : Row{limit.n, std::nan(""), std::nan("")},
                   number("%.1e", limit.error), "", holds});
  }
  if (quantity.order) {
    const Order& asked = *quantity.order;
    const Orders found = orders_of(quantity, asked);
    const bool holds = found.last && found.finite && found.least >= asked.expected - asked.within &&
                       found.most <= asked.expected + asked.within;
    const std::string wanted = number("%.1f", asked.expected) + " +- " + number("%.2f", asked.within);
    out.push_back({quantity.name + ", order from " + std::to_string(asked.from),
                   found.last ? *found.last : Row{asked.from, std::nan(""), std::nan("")}, wanted,
                   found.words(), holds});
  }
  if (quantity.extrapolated) {
    const Limit& asked = *quantity.extrapolated;
    Row worst{asked.n, std::nan(""), -1.0};
    bool holds = true;
    for (const Row& row : quantity.rows) {
      if (row.n < asked.n || !row.extrapolated) continue;
      const double error = std::abs(*row.extrapolated);
      holds = holds && error <= asked.error;
      if (error > worst.error) worst = {row.n, row.value, error};
    }
    holds = holds && worst.error >= 0.0;
    out.push_back({quantity.name + ", extrapolated", worst, number("%.1e", asked.error), "", holds});
  }
  return out;
}

std::string table_heading() {
  char text[200];
  std::snprintf(text, sizeof text, "%-4s %-58s %7s %17s %17s %9s  %-12s %-13s %s\n", "case", "quantity", "N",
                "value", "reference", "error", "limit", "order", "holds");
  return text;
}

std::string to_table(const Case& one) {
  std::string out;
  for (const Quantity& quantity : one.quantities)
    for (const Verdict& verdict : judge(quantity)) {
      char text[320];
      std::snprintf(text, sizeof text, "%-4s %-58.58s %7d %17.10g %17.10g %9.1e  %-12s %-13s %s\n",
                    one.id.c_str(), verdict.what.c_str(), verdict.row.n, verdict.row.value,
                    quantity.reference, std::abs(verdict.row.error), verdict.limit.c_str(),
                    verdict.order.c_str(), verdict.holds ? "yes" : "NO");
      out += text;
    }
  return out;
}

}  // namespace tendril::accuracy
