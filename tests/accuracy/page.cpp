#include <cmath>
#include <cstdio>

#include "accuracy/case.h"

namespace tendril::accuracy {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string element(const char* name, const std::string& inside) {
  return std::string("<") + name + ">" + inside + "</" + name + ">";
}

const char* const kStyle =
    "body{font:15px/1.5 'DejaVu Sans',Helvetica,Arial,sans-serif;color:#222;max-width:1000px;margin:2em "
    "auto;padding:0 "
    "1em}h1{font-size:1.6em}h2{font-size:1.2em;margin-top:2.2em;border-top:1px solid #ccc;padding-top:.8em}"
    "h3{font-size:1em;margin:1.2em 0 .3em}table{border-collapse:collapse;font-size:13px}td,th{padding:.15em "
    ".5em;text-align:right;border-bottom:1px solid "
    "#eee;white-space:nowrap}td:first-child,th:first-child{text-align:"
    "left;white-space:normal}.results{display:inline-block;margin-right:1.5em;vertical-align:top}.no{"
    "background:#d55e00;color:#fff}svg{margin:.6em .8em 0 0;vertical-align:top}";

std::string heading_row(std::initializer_list<const char*> names) {
  std::string out;
  for (const char* name : names) out += element("th", name);
  return element("tr", out) + "\n";
}

std::string results(const Quantity& quantity, const std::string& count) {
  bool extrapolated = false;
  for (const Row& row : quantity.rows) extrapolated = extrapolated || row.extrapolated;
  std::string out = "<div class=\"results\">" +
                    element("h3", escaped(quantity.name) + ": " + number("%.10g", quantity.reference)) +
                    "<table>" +
                    heading_row({count.c_str(), "value", ("error, " + quantity.error_is).c_str(), "order",
                                 extrapolated ? "extrapolated" : ""});
  const Row* before = nullptr;
  for (const Row& row : quantity.rows) {
    out += element("tr", element("td", std::to_string(row.n)) + element("td", number("%.10g", row.value)) +
                             element("td", number("%.2e", row.error)) +
                             element("td", before ? number("%.2f", order_between(*before, row)) : "") +
                             element("td", row.extrapolated ? number("%.1e", *row.extrapolated) : "")) +
           "\n";
    before = &row;
  }
  return out + "</table></div>\n";
}

std::string verdicts(const Case& one) {
  std::string out;
  for (const Quantity& quantity : one.quantities)
    for (const Verdict& verdict : judge(quantity))
      out += "<tr" + std::string(verdict.holds ? "" : " class=\"no\"") + ">" +
             element("td", "<a href=\"#" + one.id + "\">" + one.id + "</a> " + escaped(verdict.what)) +
             element("td", std::to_string(verdict.row.n)) + element("td", number("%.8g", verdict.row.value)) +
             element("td", number("%.8g", quantity.reference)) +
             element("td", number("%.1e", std::abs(verdict.row.error))) + element("td", verdict.limit) +
             element("td", verdict.order) + element("td", verdict.holds ? "yes" : "no") + "</tr>\n";
  return out;
}

std::string chapter(const Case& one) {
  std::string out = "<h2 id=\"" + one.id + "\">" + one.id + "  " + escaped(one.title) +
                    (one.goal.empty() ? "" : " (" + one.goal + ")") + "</h2>\n";
  out += element("p", escaped(one.formula)) + "\n<div>";
  for (const Figure& figure : one.figures) out += to_svg(figure);
  out += errors_svg(one) + "</div>\n";
  for (const Quantity& quantity : one.quantities) out += results(quantity, one.count);
  for (const std::string& note : one.notes) out += element("p", escaped(note)) + "\n";
  return out;
}

}  // namespace

std::string to_html(const std::vector<Case>& cases) {
  std::string summary, chapters;
  for (const Case& one : cases) {
    summary += verdicts(one);
    chapters += chapter(one);
  }
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Validation "
         "book</title><style>" +
         std::string(kStyle) + "</style></head><body>\n<h1>Validation book</h1>\n" +
         element("p",
                 "Rods held to closed forms, and integrators to their orders. Every line is asserted by a "
                 "test that "
                 "makes the same run.") +
         "\n<table>" +
         heading_row({"quantity", "N", "value", "reference", "error", "limit", "order", "holds"}) + summary +
         "</table>\n" + chapters + "</body></html>\n";
}

}  // namespace tendril::accuracy
