#include <viwo/core/ParallelFor.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace viwo
{
void parallelFor(size_t count, int threads, const std::function<void(size_t)>& body)
{
	if (threads <= 1 || count < 2)
	{
		for (size_t i = 0; i < count; ++i) body(i);
		return;
	}
	std::atomic<size_t> next{0};
	std::exception_ptr failure;
	std::mutex mutex;
	const auto work = [&]
	{
		for (size_t i = next++; i < count; i = next++)
		{
			try
			{
				body(i);
			}
			catch (...)
			{
				const std::lock_guard<std::mutex> lock(mutex);
				if (!failure) failure = std::current_exception();
			}
		}
	};
	std::vector<std::thread> pool;
	for (int t = 1; t < threads; ++t) pool.emplace_back(work);
	work();
	for (std::thread& thread : pool) thread.join();
	if (failure) std::rethrow_exception(failure);
}
}  // namespace viwo
