// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// The pieces of Apache ECharts that the parts use; esbuild leaves the rest out of the page.
import { init, use } from 'echarts/core';
import { BarChart, CustomChart, HeatmapChart, LineChart, ScatterChart } from 'echarts/charts';
import {
  AriaComponent, DataZoomInsideComponent, DataZoomSliderComponent, GraphicComponent, GridComponent, LegendPlainComponent,
  MarkAreaComponent, MarkLineComponent, TooltipComponent, VisualMapContinuousComponent,
} from 'echarts/components';
import { CanvasRenderer, SVGRenderer } from 'echarts/renderers';

use([
  BarChart, CustomChart, HeatmapChart, LineChart, ScatterChart,
  AriaComponent, DataZoomInsideComponent, DataZoomSliderComponent, GraphicComponent, GridComponent, LegendPlainComponent,
  MarkAreaComponent, MarkLineComponent, TooltipComponent, VisualMapContinuousComponent, CanvasRenderer, SVGRenderer,
]);

export { init };
export type { EChartsType } from 'echarts/core';
export type { EChartsOption, CustomSeriesOption, SeriesOption } from 'echarts';
export type { CustomSeriesRenderItem } from 'echarts/types/dist/echarts';
