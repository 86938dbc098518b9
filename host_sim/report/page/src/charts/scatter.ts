// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// Points in a plane, with the line y = x where both axes hold the same quantity.
import type { Cell, Scatter } from '../document';
import { inUnit, leadsWithin } from '../dom';
import { extent, resolved } from '../format';
import type { Theme } from '../theme';
import { base, colourName, margins, marksKeys, marksSeries, placed, tip, tooltip, xAxis, yAxis } from './axes';
import type { EChartsOption } from './echarts';
import type { Figure, Key } from './frame';

const manyPoints = 4000;  // above this ECharts draws a cloud as one shape, without a tooltip for each point

export function scatter(part: Scatter): Figure {
  const all = part.clouds.flatMap((cloud) => cloud.x.map((x, i): Cell[] => [cloud.name, cloud.labels[i] ?? '', x, cloud.y[i]]));
  return {
    title: part.title, caption: part.caption, height: () => 360,
    summary: `${part.y.label} over ${part.x.label}, ${all.length} points in ${part.clouds.length} series.`,
    keys: part.clouds.map((cloud) => ({ name: cloud.name, colour: colourName(cloud.meaning), look: 'points', toggles: part.clouds.length > 1 } as Key)).concat(marksKeys(part.marks)),
    numbers: {
      columns: [{ label: 'Series', digits: 4, numeric: false }, { label: 'Point', digits: 4, numeric: false },
        { ...part.x, digits: 5, numeric: true }, { ...part.y, digits: 5, numeric: true }],
      rows: all.length, row: (i) => all[i],
    },
    option: (colours, width) => option(part, colours, width),
    ready: (chart) => chart.on('click', (hit) => {
      const href = part.clouds[hit.seriesIndex ?? -1]?.hrefs?.[hit.dataIndex];
      if (href && leadsWithin(href)) location.href = href;
    }),
  };
}

function option(part: Scatter, colours: Theme, width: number): EChartsOption {
  const onX = resolved(part.x, part.clouds.flatMap(({ x }) => x));
  const onY = resolved(part.y, part.clouds.flatMap(({ y }) => y));
  return {
    ...base(colours), grid: { ...margins(width), bottom: 46 },
    xAxis: xAxis(part.x, colours), yAxis: yAxis(part.y, colours, width),
    legend: { show: false, data: part.clouds.map((cloud) => cloud.name) },
    tooltip: tooltip(colours, 'item', (hit) => {
      const { seriesIndex, dataIndex } = hit as { seriesIndex: number; dataIndex: number };
      const cloud = part.clouds[seriesIndex];
      return tip(cloud.labels[dataIndex] ?? cloud.name, [
        { name: part.x.label, amount: inUnit(onX(cloud.x[dataIndex]), part.x.unit) },
        { name: part.y.label, amount: inUnit(onY(cloud.y[dataIndex]), part.y.unit) }]);
    }),
    series: [
      ...part.clouds.map((cloud) => ({
        type: 'scatter' as const, name: cloud.name, symbolSize: cloud.x.length > 500 ? 4 : 8,
        large: cloud.x.length > manyPoints, itemStyle: { color: colours.meaning(cloud.meaning), opacity: 0.75 },
        data: cloud.x.map((x, i) => [placed(part.x, x), placed(part.y, cloud.y[i])]),
      })),
      ...(part.identity ? [identityLine(part, colours)] : []),
      ...marksSeries(part.marks, [], colours),
    ],
  } as EChartsOption;
}

/** Across what both axes show. */
function identityLine(part: Scatter, colours: Theme) {
  const known = part.clouds.flatMap((cloud) => [...cloud.x, ...cloud.y]).map((value) => placed(part.x, value));
  const ends = extent([...(part.x.range ?? []), ...(part.y.range ?? []), ...known]);
  return { type: 'line' as const, name: '\u200bidentity', data: ends[0] <= ends[1] ? ends.map((end) => [end, end]) : [],
    showSymbol: false, silent: true, lineStyle: { color: colours.meaning('reference'), type: 'dashed' as const, width: 1.2 } };
}
