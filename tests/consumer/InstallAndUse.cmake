# cmake -DBUILD=<viwo's build folder> -DSOURCE=<this folder> -DWORK=<scratch folder> -P InstallAndUse.cmake
# Installs viwo under a prefix of its own, then configures, builds and runs the consumer project against that.
function(run_step what)
	execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
	if(NOT status EQUAL 0)
		message(FATAL_ERROR "${what} failed (${status}):\n${output}")
	endif()
	message(STATUS "${what}: done")
endfunction()

file(REMOVE_RECURSE ${WORK})
run_step("Install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run_step("Configure the consumer" ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run_step("Build the consumer" ${CMAKE_COMMAND} --build ${WORK}/build)
run_step("Run the consumer" ${WORK}/build/viwo_consumer)
if(EXISTS ${WORK}/prefix/bin/viwo-evaluate)
	run_step("Run an installed program" ${WORK}/prefix/bin/viwo-evaluate --version)
endif()
file(REMOVE_RECURSE ${WORK})
