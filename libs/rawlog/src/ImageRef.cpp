#include <viwo/core/TimeText.h>
#include <viwo/rawlog/ObservationAdapter.h>

namespace viwo
{
mrpt::img::CImage ImageRef::grey() const
{
	const auto& image = observation_->image;
	const std::string name = image.isExternallyStored() ? image.getExternalStorageFileAbsolutePath() : "image embedded in the rawlog";
	const std::string where = name + ", at " + formatSeconds(t_ns) + " s: ";
	mrpt::img::CImage grey;
	try
	{
		observation_->load();
		if (image.isEmpty()) throw Error("empty");
		// A copy in any case: unload() below takes the pixels of an external image back.
		if (image.isColor())
			grey = image.grayscale();
		else
			grey = image.makeDeepCopy();
		observation_->unload();
	}
	catch (const std::exception&)
	{
		throw Error(where + "this image is missing or cannot be decoded; restore the file");
	}
	const auto& camera = observation_->cameraParams;
	if (grey.getWidth() != camera.ncols || grey.getHeight() != camera.nrows)
		throw Error(where + "the image has " + std::to_string(grey.getWidth()) + " x " + std::to_string(grey.getHeight()) +
		            " pixels, its calibration " + std::to_string(camera.ncols) + " x " + std::to_string(camera.nrows) +
		            "; calibrate at the size that is recorded");
	return grey;
}
}  // namespace viwo
