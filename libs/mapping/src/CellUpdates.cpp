#include "CellUpdates.h"

#include <cmath>

namespace viwo
{
namespace
{
/** KeyRay has room for 100,000 voxels and does not look whether it is used up; a ray passes three times as many as its length has, at most.
 */
constexpr double kLongestRay_voxels = 33000;

octomap::point3d endWithin(const Ray& ray, double max_range_m)
{
	const octomap::point3d direction = (ray.end - ray.origin).normalized();
	return ray.origin + direction * static_cast<float>(max_range_m);
}

bool isFinite(const octomap::point3d& p)
{
	return std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z());
}

/** What becomes of one scan's rays. */
class ScanCells
{
   public:
	ScanCells(size_t scan_index, const octomap::OcTree& geometry, const RayCasting& options, CellScratch& scratch,
	          std::vector<CellUpdate>& updates)
	    : scan_index_(scan_index), geometry_(geometry), options_(options), scratch_(scratch), updates_(updates)
	{
		scratch_.seen.clear();
		scratch_.seen_ends.clear();
	}

	/** Occupies the ray's end; what the ray passes is cleared by clearAll(), as hits prevail. */
	void hit(Ray ray)
	{
		if (options_.discretize && isFinite(ray.end))
		{
			octomap::OcTreeKey key;
			if (geometry_.coordToKeyChecked(ray.end, key))
			{
				if (!scratch_.seen_ends.insert(key)) return;
				ray.end = geometry_.keyToCoord(key);
			}
		}
		if (!pass(ray) || isTooLong(ray)) return;
		const octomap::OcTreeKey key = geometry_.coordToKey(ray.end);
		if (scratch_.seen.insert(key)) updates_.push_back(cellUpdate(key, scan_index_, true));
	}

	/** Remembers the ray, up to the range limit. @return false where it cannot be cast. */
	bool pass(Ray ray)
	{
		if (isFinite(ray.origin) && isFinite(ray.end))
		{
			if (isTooLong(ray)) ray.end = endWithin(ray, options_.max_range_m);
			octomap::OcTreeKey key;
			if (geometry_.coordToKeyChecked(ray.origin, key) && geometry_.coordToKeyChecked(ray.end, key) &&
			    (ray.end - ray.origin).norm() < kLongestRay_voxels * geometry_.getResolution())
			{
				passing_.push_back(ray);
				return true;
			}
		}
		++unusable_;
		return false;
	}

	void clearAll()
	{
		for (const Ray& ray : passing_)
		{
			geometry_.computeRayKeys(ray.origin, ray.end, scratch_.ray);
			for (const octomap::OcTreeKey& key : scratch_.ray)
				if (scratch_.seen.insert(key)) updates_.push_back(cellUpdate(key, scan_index_, false));
		}
	}

	size_t unusable() const { return unusable_; }

   private:
	bool isTooLong(const Ray& ray) const { return options_.max_range_m >= 0.0 && !((ray.end - ray.origin).norm() <= options_.max_range_m); }

	size_t scan_index_;
	const octomap::OcTree& geometry_;
	const RayCasting& options_;
	CellScratch& scratch_;
	std::vector<CellUpdate>& updates_;
	std::vector<Ray> passing_;
	size_t unusable_ = 0;
};

uint16_t gatherBits(uint64_t x)
{
	uint16_t value = 0;
	for (int i = 0; i < 16; ++i) value = static_cast<uint16_t>(value | (x >> (3 * i) & 1u) << i);
	return value;
}
}  // namespace

octomap::OcTreeKey keyOf(CellUpdate update)
{
	const uint64_t morton = update >> kMortonShift;
	return octomap::OcTreeKey(gatherBits(morton), gatherBits(morton >> 1), gatherBits(morton >> 2));
}

size_t appendUpdates(const RayScan& scan, size_t scan_index, const octomap::OcTree& geometry, const RayCasting& options,
                     CellScratch& scratch, std::vector<CellUpdate>& updates)
{
	ScanCells cells(scan_index, geometry, options, scratch, updates);
	for (const Ray& ray : scan.hits) cells.hit(ray);
	for (const Ray& ray : scan.clearing) cells.pass(ray);
	cells.clearAll();
	return cells.unusable();
}
}  // namespace viwo
