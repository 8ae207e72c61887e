#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "figure.h"
#include "study/svg.h"

namespace tendril::gallery {
namespace {

using svg::escaped;

const char* const kStyle =
    "body{font:15px/1.5 'DejaVu Sans',Helvetica,Arial,sans-serif;color:#222;max-width:1080px;margin:2em auto;"
    "padding:0 1em}h1{font-size:1.6em}h2{font-size:1.2em;margin-top:2.2em;border-top:1px solid #ccc;"
    "padding-top:.8em}table{border-collapse:collapse;font-size:13px;margin:.8em 0}td,th{padding:.25em .6em;"
    "text-align:left;border-bottom:1px solid #e4e4e4;vertical-align:top}td.n{text-align:right;white-space:"
    "nowrap}figure{display:inline-block;margin:.4em .8em .4em 0;vertical-align:top}figcaption{font-size:12px;"
    "color:#555;max-width:520px}code{background:#f3f3f3;padding:.1em .3em}.holds{color:#00694d}.partly{color:"
    "#7a5a00}.fails{color:#b03a00}.out{background:#d55e00;color:#fff}svg{max-width:100%;height:auto}";

std::string element(const std::string& name, const std::string& inside, const std::string& kind = "") {
  return "<" + name + (kind.empty() ? "" : " class=\"" + kind + "\"") + ">" + inside + "</" + name + ">";
}

const char* const kElsewhere =
    "<h2>Elsewhere in the tree</h2>\n<ul>"
    "<li>3.5, integrators, error against run time: <code>tendril report "
    "examples/scenes/cantilever.json</code></li>"
    "<li>3.22, 3.23, the bounding cylinder and what sticks out of it: "
    "<code>build/bin/culling_test</code></li>"
    "<li>4.4, a ball falls on a crooked leaf: <code>tendril run "
    "examples/scenes/ball_on_leaf_blade.json</code></li></ul>\n";

std::string claim_row(const Figure& figure, const Claim& claim) {
  const std::string verdict = to_string(claim.verdict);
  const std::string because = claim.because.empty() ? "" : ": " + escaped(claim.because);
  return element("tr", element("td", "<a href=\"#f" + figure.id + "\">" + figure.id + "</a>") +
                           element("td", escaped(claim.claimed)) + element("td", escaped(claim.measured)) +
                           element("td", element("b", verdict) + because, verdict)) +
         "\n";
}

std::string number_row(const Number& number) {
  std::string held = "a time: not held to anything";
  if (number.within) {
    held = text("%.4g", number.within->low) + " to " + text("%.4g", number.within->high);
    if (std::isinf(number.within->high)) held = "at least " + text("%.4g", number.within->low);
  }
  return element("tr",
                 element("td", escaped(number.name)) + element("td", text("%.4g", number.value), "n") +
                     element("td", held),
                 number.holds() ? "" : "out") +
         "\n";
}

std::string section(const Figure& figure) {
  std::string out = "<h2 id=\"f" + figure.id + "\">" + figure.id + "  " + escaped(figure.title) + "</h2>\n" +
                    element("p", escaped(figure.what)) + "\n" +
                    element("p", element("code", "bash examples/gallery.sh --only " + figure.id)) + "\n<div>";
  for (const Picture& picture : figure.pictures)
    out += element("figure", picture.svg + element("figcaption", escaped(picture.caption))) + "\n";
  out += "</div>\n<table><tr><th>number</th><th>measured</th><th>held by the test to</th></tr>\n";
  for (const Number& number : figure.numbers) out += number_row(number);
  out += "</table>\n";
  if (!figure.left_out.empty()) out += element("p", escaped(figure.left_out)) + "\n";
  for (const std::string& note : figure.notes) out += element("p", escaped(note)) + "\n";
  return out;
}

}  // namespace

std::string text(const char* format, double value) {
  char out[200];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::partly:
      return "partly";
    case Verdict::fails:
      return "fails";
  }
  return "";
}

double Figure::number(const std::string& name) const {
  for (const Number& one : numbers)
    if (one.name == name) return one.value;
  throw std::out_of_range("no number " + name);
}

std::string to_html(const std::vector<Figure>& figures) {
  std::string claims, sections;
  for (const Figure& figure : figures) {
    for (const Claim& claim : figure.claims) claims += claim_row(figure, claim);
    sections += section(figure);
  }
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>The thesis's experiments, "
         "measured</title><style>" +
         std::string(kStyle) + "</style></head><body>\n<h1>The thesis's experiments, measured</h1>\n" +
         element("p",
                 "Experiments of [Chan 2008], Dynamic Axial Curve-pair based Deformation and its "
                 "Application, run with tendril beside what the thesis compares with. Objects are generated. "
                 "Times are processor times of one thread on the machine that made this page; all other "
                 "numbers are held to the bounds beside them by the test gallery_test.") +
         "\n<table><tr><th>figure</th><th>what it claims</th><th>what we "
         "measured</th><th>verdict</th></tr>\n" +
         claims + "</table>\n" + sections + kElsewhere + "</body></html>\n";
}

}  // namespace tendril::gallery
