// SPDX-License-Identifier: MIT
// Embree 3 and 4: what each calls the ways in which rays are shot with a filter of their own.
#pragma once

#if CLPV_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace clpv::reference {

#if CLPV_EMBREE_MAJOR >= 4

using RtcContext = RTCRayQueryContext;
inline constexpr RTCSceneFlags kRtcOwnFilters = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

/// `filter` may be null: then it is the geometries' alone.
inline void rtc_intersect(RTCScene scene, RtcContext& context, RTCFilterFunctionN filter, RTCRayHit& query) {
  rtcInitRayQueryContext(&context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.filter = filter;
  if (filter != nullptr) arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;  // of every geometry
  rtcIntersect1(scene, &query, &arguments);
}

inline void rtc_occluded(RTCScene scene, RTCRay& ray) {
  rtcOccluded1(scene, &ray);
}

#else

using RtcContext = RTCIntersectContext;
inline constexpr RTCSceneFlags kRtcOwnFilters = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

inline void rtc_intersect(RTCScene scene, RtcContext& context, RTCFilterFunctionN filter, RTCRayHit& query) {
  rtcInitIntersectContext(&context);
  context.filter = filter;
  rtcIntersect1(scene, &context, &query);
}

inline void rtc_occluded(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}

#endif

}  // namespace clpv::reference
