// Compares a rendered picture with its baseline for the regression tests. Prints OpenImageIO's error
// figures and fails when more than a small share of the pixels is visibly different: a changed pixel
// along an outline is a driver's rounding, a changed area is a defect that a mean error would hide.
//
//   hrtCompareImages PICTURE BASELINE [DIFFERENCE.png]
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <cstdio>
#include <string>

namespace
{

// A pixel differs visibly when a channel is off by more than 4 of 255: shading that is computed in a
// different order moves by one, and an outline that moves by a pixel by far more.
constexpr float kVisible = 4.0f / 255.0f;

// Share of the pixels that may differ visibly: the bound for wrong ids of rasterised visibility, which
// is also what another rasteriser may decide otherwise along outlines and shadow borders.
constexpr double kShare = 0.002;

bool read(const char* path, OIIO::ImageBuf& image)
{
  image.reset(path);
  if (!image.read(0, 0, true, OIIO::TypeDesc::FLOAT))
  {
    std::printf("%s: %s\n", path, image.geterror().c_str());
    return false;
  }
  return true;
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc < 3)
  {
    std::printf("usage: hrtCompareImages PICTURE BASELINE [DIFFERENCE.png]\n");
    return 2;
  }
  OIIO::ImageBuf picture, baseline;
  if (!read(argv[1], picture) || !read(argv[2], baseline))
  {
    return 2;
  }
  if (picture.roi() != baseline.roi() || picture.nchannels() != baseline.nchannels())
  {
    std::printf("the sizes differ: %d x %d x %d against %d x %d x %d\n", picture.spec().width,
      picture.spec().height, picture.nchannels(), baseline.spec().width, baseline.spec().height,
      baseline.nchannels());
    return 1;
  }
  const auto figures = OIIO::ImageBufAlgo::compare(picture, baseline, kVisible, kVisible);
  const double pixels = double(picture.spec().width) * picture.spec().height;
  const double share = double(figures.nfail) / pixels;
  std::printf("mean error %g, RMSE %g, PSNR %g dB, largest %g at (%d, %d); %.4f %% of the pixels "
              "differ by more than 4/255 (allowed %.2f %%)\n",
    figures.meanerror, figures.rms_error, figures.PSNR, figures.maxerror, figures.maxx,
    figures.maxy, 100.0 * share, 100.0 * kShare);
  if (share <= kShare)
  {
    return 0;
  }
  if (argc > 3)
  {
    OIIO::ImageBufAlgo::absdiff(picture, baseline).write(argv[3]);
    std::printf("wrote the difference to %s\n", argv[3]);
  }
  return 1;
}
