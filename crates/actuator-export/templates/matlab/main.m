classdef {{name}} < handle
    % {{name}}  An identified piezo actuator, voltage in, equivalent flap angle out, and its inverse.
    %
{{about}}
    %
    % Fixed time step {{time_step_s}} s. Command range {{lowest_volt}} V to {{highest_volt}} V.
    %
    %   flap = {{name}}({{middle_volt}});            % at rest at a voltage
    %   deg = flap.step({{middle_volt}} + 1.0);      % flap angle one time step later, deg
    %
    %   flap.inverse_start({{name}}.rest_volt(0.0));
    %   volt = flap.inverse_step(0.1);    % the voltage for 0.1 deg one time step later
    %   if flap.out_of_reach, end         % the flap does not follow: it goes to expected_deg
    %
    %   degs = flap.simulate(volts);      % whole histories
    %   volts = flap.invert(wanted);

    properties (SetAccess = private)
        output_deg = 0;          % flap angle, deg
        status = 0;              % of the last sample: sum of 1 (voltage beyond the command range, held
                                 % there), 2 (no finite number: the state is left), 4 (diverged)
        expected_deg = 0;        % flap angle that the compensator expects of its last command, deg
        out_of_reach = false;    % where the flap cannot follow: of one step, or at every sample
    end

    properties (Access = private)
        p                        % numbers
        m                        % actuator
        r                        % compensator
    end

    methods
        function obj = {{name}}(volt)
            obj.p = numbers();
            if nargin < 1
                volt = 0.5 * (obj.p.LOWEST_VOLT + obj.p.HIGHEST_VOLT);
            end
            obj.start(volt);
            obj.inverse_start(volt);
        end

        function deg = start(obj, volt)
            % The actuator at rest at a voltage, V; returns the flap angle there, deg.
            obj.m = chain_start(obj.p, volt);
            deg = obj.m.output_deg;
            obj.output_deg = deg;
            obj.status = obj.m.status;
        end

        function deg = step(obj, volt)
            % One time step on: the voltage at its end, V, to the flap angle there, deg.
            obj.m = chain_step(obj.p, obj.m, volt);
            deg = obj.m.output_deg;
            obj.output_deg = deg;
            obj.status = obj.m.status;
        end

        function deg = inverse_start(obj, volt)
            % The compensator, its model at rest at a voltage, V; returns the flap angle there, deg.
            obj.r = compensator_start(obj.p, volt);
            deg = obj.r.model.output_deg;
            obj.expected_deg = deg;
            obj.out_of_reach = false;
        end

        function volt = inverse_step(obj, wanted_deg)
            % One time step on: the flap angle wanted at its end, deg, to the voltage to command, V.
            obj.r = compensator_step(obj.p, obj.r, wanted_deg);
            volt = obj.r.volt;
            obj.expected_deg = obj.r.model.output_deg;
            obj.out_of_reach = obj.r.out_of_reach;
        end

        function degs = simulate(obj, volts)
            % The flap angles, deg, at every sample of a voltage history, V, from rest at its first.
            degs = zeros(size(volts));
            for i = 1:numel(volts)
                if i == 1
                    degs(i) = obj.start(volts(i));
                else
                    degs(i) = obj.step(volts(i));
                end
            end
        end

        function volts = invert(obj, wanted)
            % The voltages, V, for every sample of wanted flap angles, deg, from rest at the first;
            % out_of_reach afterwards tells at which samples the flap does not follow.
            volts = zeros(size(wanted));
            out = false(size(wanted));
            for i = 1:numel(wanted)
                if i == 1
                    obj.inverse_start({{name}}.rest_volt(wanted(i)));
                    volts(i) = obj.r.volt;
                    out(i) = ~(abs(obj.expected_deg - wanted(i)) <= obj.p.REST_TOLERANCE_DEG);
                else
                    volts(i) = obj.inverse_step(wanted(i));
                    out(i) = obj.out_of_reach;
                end
            end
            obj.out_of_reach = out;
        end
    end

    methods (Static)
        function volt = rest_volt(wanted_deg)
            % The voltage, V, at which the actuator rests at a flap angle, deg, as near as the range
            % allows.
            p = numbers();
            low = p.LOWEST_VOLT;
            high = p.HIGHEST_VOLT;
            at = @(volt) getfield(chain_start(p, volt), 'output_deg');
            rises = at(low) <= at(high);
            for i = 1:60
                middle = 0.5 * (low + high);
                if (at(middle) < wanted_deg) == rises
                    low = middle;
                else
                    high = middle;
                end
            end
            volt = 0.5 * (low + high);
        end
    end
end

function p = numbers()
    % All numbers of the actuator.
{{constants}}
end

function x = held(x, low, high)
    % x, but at least low and at most high.
    x = min(max(x, low), high);
end

function s = sign_of(x)
    % The sign of x, that of zero being positive.
    s = 1.0 - 2.0 * (x < 0.0);
end

% ------------------------------------------------------------------------------------------ the law
%
% {{law_title}}.
%
{{law_equation}}

{{law}}
{{stages}}
% ------------------------------------------------------------------------------------------ forward

function [taken, status] = admitted(p, volt)
    % The voltage that is taken for a command: commands a little beyond the range pass.
    taken = held(volt, p.LOWEST_VOLT - p.BEYOND_VOLT, p.HIGHEST_VOLT + p.BEYOND_VOLT);
    status = double(taken ~= volt);
end

function m = chain_start(p, volt)
    % The actuator at rest at a voltage.
    bad = ~isfinite(volt);
    if bad
        volt = 0.5 * (p.LOWEST_VOLT + p.HIGHEST_VOLT);
    end
    [volt, m.status] = admitted(p, volt);
{{amplifier_start}}
    m.law_volt = volt;
    [deg, m.law] = law_start(p, volt);
{{linkage_start}}
    m.output_deg = deg;
    if bad
        m.status = 2;
    end
end

function m = chain_step(p, m, volt)
    % One time step on.
    if ~isfinite(volt)
        m.status = 2;
        return
    end
    [volt, m.status] = admitted(p, volt);
{{amplifier_step}}
    m.law_volt = volt;
    [deg, m.law] = law_step(p, m.law, volt);
{{linkage_step}}
    m.output_deg = deg;
    if ~isfinite(deg)
        m.status = m.status + 4;
    end
end

% ------------------------------------------------------------------------------------------ inverse

function b = between(p, law, wanted_deg, a, off_a, b, off_b)
    % Between two voltages at which the law's next output lies on either side of the wanted one:
    % regula falsi, the end that stays twice is counted half (Illinois).
    for i = 1:80
        if abs(off_b) <= p.TOLERANCE_DEG
            break
        end
        volt = b - off_b * (b - a) / (off_b - off_a);
        if ~((volt > a) ~= (volt > b))
            volt = 0.5 * (a + b);
        end
        off = law_probe(p, law, volt) - wanted_deg;
        if (off < 0.0) ~= (off_b < 0.0)
            a = b;
            off_a = off_b;
        else
            off_a = 0.5 * off_a;
        end
        b = volt;
        off_b = off;
    end
end

function [volt, reached] = law_inverse(p, law, last_volt, wanted_deg)
    % The voltage nearest to the last one at which the law's next output is the wanted one, and
    % whether there is one. Searched in growing strides, first in the direction in which the output
    % rises or falls towards it. Where there is none, the end of the range that comes nearest.
    here = held(last_volt, p.LOWEST_VOLT, p.HIGHEST_VOLT);
    off_here = law_probe(p, law, here) - wanted_deg;
    volt = here;
    off_nearest = off_here;
    reached = true;
    if abs(off_here) <= p.TOLERANCE_DEG
        return
    end
    ends = [p.HIGHEST_VOLT, p.LOWEST_VOLT];
    if ~(off_here < 0.0)
        ends = fliplr(ends);
    end
    for last = ends
        stride = (p.HIGHEST_VOLT - p.LOWEST_VOLT) / 256.0;
        b = here;
        off_b = off_here;
        while b ~= last
            a = b;
            off_a = off_b;
            if abs(last - b) <= stride
                b = last;
            else
                b = b + stride * sign_of(last - b);
            end
            stride = 4.0 * stride;
            off_b = law_probe(p, law, b) - wanted_deg;
            if (off_b < 0.0) ~= (off_a < 0.0) || abs(off_b) <= p.TOLERANCE_DEG
                volt = between(p, law, wanted_deg, a, off_a, b, off_b);
                return
            end
        end
        if abs(off_b) < abs(off_nearest)
            volt = b;
            off_nearest = off_b;
        end
    end
    reached = false;
end

function r = compensator_start(p, volt)
    % The compensator, its model at rest at a voltage.
    if ~isfinite(volt)
        volt = 0.5 * (p.LOWEST_VOLT + p.HIGHEST_VOLT);
    end
    r.volt = held(volt, p.LOWEST_VOLT, p.HIGHEST_VOLT);
    r.model = chain_start(p, r.volt);
    r.out_of_reach = false;
{{inverse_start}}
end

function r = compensator_step(p, r, wanted_deg)
    % One time step on.
    reached = isfinite(wanted_deg);
    if reached
        % from the flap back to the command, stage by stage
        deg = wanted_deg;
{{inverse}}
        r.volt = held(volt, p.LOWEST_VOLT, p.HIGHEST_VOLT);
        reached = reached && r.volt == volt;
    end
    % and forward again: the memory is that of the command given
    r.model = chain_step(p, r.model, r.volt);
{{follow}}
    r.out_of_reach = ~reached;
end
