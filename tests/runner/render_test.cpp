#include "draw/drawing.h"
#include "runner/program.h"

#include <tendril/bind/import.h>

namespace tendril::test {
namespace {

using runner::Camera;
using runner::CameraFit;
using runner::Drawing;
using runner::Picture;
using runner::Strand;
using scene::ViewOptions;

ViewOptions small_view() {
  scene::ViewOptions view;
  view.width = 80;
  view.height = 60;
  view.samples = 4;
  return view;
}

int brightness(Picture& picture, int x, int y) {
  const auto* p = picture.pixel(x, y);
  return p[0] + p[1] + p[2];
}

struct Scene {
  bind::PolygonMesh mesh = bind::parse_off(tube_off(), "tube");
  scene::ViewOptions view = small_view();
  Camera camera() const {
    CameraFit fit(view);
    fit.include(mesh.points);
    return fit.camera();
  }
};

TEST(Render, ShowsTheObjectBeforeAPaleGround) {
  const Scene scene;
  Picture picture = draw({&scene.mesh, {}, {}}, scene.camera(), scene.view, 1);
  ASSERT_EQ(picture.rgb.size(), 80U * 60U * 3U);
  for (const auto& [x, y] : {std::pair{0, 0}, std::pair{79, 0}, std::pair{2, 30}}) {
    EXPECT_GT(brightness(picture, x, y), 3 * 200);
  }
  EXPECT_LT(brightness(picture, 40, 30), 3 * 200);
  EXPECT_GT(brightness(picture, 40, 30), 3 * 20);
}

TEST(Render, CastsAShadowOnTheGround) {
  const Scene scene;
  Picture with = draw({&scene.mesh, {}, {}}, scene.camera(), scene.view, 1);
  Picture without = draw({nullptr, {}, {}}, scene.camera(), scene.view, 1);
  int darker = 0;
  for (int x = 48; x < 80; ++x) {
    for (int y = 30; y < 60; ++y) darker += brightness(with, x, y) < brightness(without, x, y) - 60 ? 1 : 0;
  }
  EXPECT_GT(darker, 20);
}

TEST(Render, IsTheSamePictureForAnyNumberOfThreads) {
  const Scene scene;
  const Drawing drawing{
      &scene.mesh, {}, {{Strand::Kind::balls, {Vec3(0, 0.5, 0)}, 0.05, runner::Vec3f(1, 0, 0)}}};
  const Picture one = draw(drawing, scene.camera(), scene.view, 1);
  EXPECT_EQ(one.rgb, draw(drawing, scene.camera(), scene.view, 2).rgb);
  EXPECT_EQ(one.rgb, draw(drawing, scene.camera(), scene.view, 5).rgb);
  EXPECT_EQ(png_bytes(one), png_bytes(one));
}

TEST(Render, IsWhatAFinerPictureShows) {
  // Edges, half shadows and the sky's light in corners are sampled where they are, at any size of the pixels.
  Scene scene;
  scene.view.samples = 12;
  Picture coarse = draw({&scene.mesh, {}, {}}, scene.camera(), scene.view, 1);
  scene.view.width *= 5, scene.view.height *= 5;
  Picture fine = draw({&scene.mesh, {}, {}}, scene.camera(), scene.view, 1);
  double sum = 0.0, most = 0.0;
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x) {
      double mean = 0.0;
      for (int k = 0; k < 25; ++k) mean += brightness(fine, 5 * x + k % 5, 5 * y + k / 5) / 75.0;
      const double off = std::abs(brightness(coarse, x, y) / 3.0 - mean);
      sum += off, most = std::max(most, off);
    }
  std::printf("%.2f of 255 on the mean, %.1f at most\n", sum / (80 * 60), most);
  EXPECT_LT(sum / (80 * 60), 1.0);
  EXPECT_LT(most, 40.0);
}

TEST(Render, KeepsEveryPointWithinThePictureWithAMargin) {
  Scene scene;
  for (const double yaw : {-170.0, -35.0, 0.0, 60.0}) {
    for (const double pitch : {-60.0, 5.0, 80.0}) {
      scene.view.yaw = yaw;
      scene.view.pitch = pitch;
      const Camera camera = scene.camera();
      double widest = 0.0;
      for (const Vec3& p : scene.mesh.points) {
        const Vec3 d = p - camera.eye;
        const double x = d.dot(camera.right) / (camera.tan_x * d.dot(camera.forward));
        const double y = d.dot(camera.up) / (camera.tan_y * d.dot(camera.forward));
        widest = std::max({widest, std::abs(x), std::abs(y)});
      }
      EXPECT_LT(widest, 0.95) << yaw << ' ' << pitch;
      EXPECT_GT(widest, 0.7) << yaw << ' ' << pitch;
    }
  }
}

TEST(Render, DrawsStrandsOverTheSurfaceThatHidesThem) {
  const Scene scene;
  const runner::Vec3f red(0.8F, 0.0F, 0.0F);
  const Strand inside{Strand::Kind::tube, {Vec3(0, 0.2, 0), Vec3(0, 0.8, 0)}, 0.03, red};
  Picture plain = draw({&scene.mesh, {}, {}}, scene.camera(), scene.view, 1);
  Picture over = draw({&scene.mesh, {}, {inside}}, scene.camera(), scene.view, 1);
  const auto redness = [](Picture& p) { return p.pixel(40, 30)[0] - p.pixel(40, 30)[1]; };
  EXPECT_GT(redness(over), redness(plain) + 30);
  EXPECT_EQ(brightness(over, 2, 30), brightness(plain, 2, 30));
}

TEST(Render, ARodIsAsThickAsItsEdgesAreWide) {
  const std::vector<Vec3> p{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  const CurvePair pair(KnotVector(1, {0, 0, 0.5, 1, 1}), p, {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(2, 1, 0)});
  const Strand rod = runner::rod_strand(pair, std::vector{0.0, 0.5, 1.0}, std::vector{0.4, 0.2}, 0.12);
  ASSERT_EQ(rod.radii.size(), rod.points.size());
  EXPECT_EQ(rod.radii.front(), 0.2);
  EXPECT_EQ(rod.radii.back(), 0.12);  // the least, instead of 0.1
  for (std::size_t i = 0; i < rod.points.size(); ++i) {
    if (std::abs(rod.points[i].x() - 0.5) < 1e-12) EXPECT_NEAR(rod.radii[i], 0.175, 1e-12);
    if (std::abs(rod.points[i].x() - 1.0) < 1e-12) EXPECT_NEAR(rod.radii[i], 0.15, 1e-12);
  }
}

TEST(Render, TheProgramWritesAPngOfTheSizeAsked) {
  const Folder folder;
  folder.write("tube.off", tube_off());
  const Outcome outcome = folder.run("render tube.off --out tube.png --size 120x50 --samples 1 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string png = bytes_of(folder / "tube.png");
  ASSERT_GT(png.size(), 33U);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\x78\0\0\0\x32", 8));
}

}  // namespace
}  // namespace tendril::test
