#include <viwo/core/AtomicFile.h>
#include <viwo/core/Error.h>
#include <viwo/core/TimeText.h>
#include <viwo/rawlog/RawlogWriter.h>

#include <filesystem>
#include <string>
#include <vector>

#include "GzipArchive.h"

namespace fs = std::filesystem;

namespace viwo
{
struct RawlogWriter::Impl
{
	explicit Impl(const std::string& path) : path(path), file(path), archive(file.stream()) {}

	~Impl()
	{
		if (closed) return;
		std::error_code ignored;
		for (const std::string& image : new_images) fs::remove(image, ignored);
		if (made_folder) fs::remove(images_folder, ignored);  // not while it holds anything
	}

	std::string path, images_folder;
	bool made_folder = false, closed = false;
	std::vector<std::string> new_images;
	AtomicFile file;
	GzipArchiveWriter archive;
};

RawlogWriter::RawlogWriter(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::obs::CObservation& observation)
{
	impl_->archive.WriteObject(observation);
}

void RawlogWriter::close()
{
	impl_->archive.finish();
	impl_->file.commit();
	impl_->closed = true;
}

const std::string& RawlogWriter::imagesFolder()
{
	if (impl_->images_folder.empty())
	{
		const fs::path rawlog(impl_->path);
		const std::string folder = (rawlog.parent_path() / (rawlog.stem().string() + "_Images")).string();
		std::error_code error;
		impl_->made_folder = fs::create_directories(folder, error);
		std::error_code ignored;
		if (error && fs::exists(fs::symlink_status(folder, ignored)))
			throw Error(folder +
			            ": the images' folder cannot be made, a file of this name is in the way; move it away, or give the rawlog "
			            "another name");
		if (error) throw Error(folder + ": cannot create this folder: " + error.message());
		impl_->images_folder = folder;
	}
	return impl_->images_folder;
}

std::string RawlogWriter::imageName(const std::string& label, int64_t t_ns, const std::string& extension)
{
	return label + "_" + formatSeconds(t_ns) + "." + extension;
}

std::string RawlogWriter::imagePath(const std::string& label, int64_t t_ns, const std::string& extension)
{
	const std::string image = imagesFolder() + "/" + imageName(label, t_ns, extension);
	std::error_code ignored;
	if (!fs::exists(fs::symlink_status(image, ignored))) impl_->new_images.push_back(image);
	return image;
}
}  // namespace viwo
